# SPDX-License-Identifier: GPL-3.0-or-later
"""A cube in meshless water floats at Archimedes' draught, also where it has a tenth of the water's density;
one that falls in dives, comes up, and neither makes nor takes water or energy; also in space. As fluid of a high
viscosity it does the same and keeps its volume."""
import shutil

from run_case import Test

test = Test()


def continues(result, case, values, name):
    """From its first checkpoint, at step 20, the run goes on to the same statistics."""
    whole = (result.directory / "statistics.csv").read_bytes()
    for checkpoint in sorted((result.directory / "checkpoints").glob("step_*"))[1:]:
        shutil.rmtree(checkpoint)
    rest = test.run(case, values, options=("--restart",), directory=result.directory)
    test.check(f"{name}: it was continued", "step 20," in rest.text)
    test.check(f"{name}: continued, the statistics are the same",
               (result.directory / "statistics.csv").read_bytes() == whole)


CASE, COARSE = "falling_cube/falling_cube.prm", {"Bodies/water/Spacing": "40 mm", "Bodies/cube/Mesh/Subdivisions": 5}
for density, draught in ((500, 0.1), (100, 0.02)):
    start = {**COARSE, "Bodies/cube/Density": density, "Bodies/cube/Free directions": "y", "End time": "1",
             "Bodies/cube/Mesh/Lower corner": f"0.5, {0.6 - draught}",
             "Bodies/cube/Mesh/Upper corner": f"0.7, {0.8 - draught}"}
    result = test.run(CASE, start)
    test.check(f"{density}: the verdict is OK", "verdict: OK" in result.text)
    heights = result["cube.centre.y [m]"]
    test.band(f"{density}: rise over the draught's height, in spacings", (max(heights) - 0.7 + draught) / 0.04, -1e-6, 1e-6)
    test.band(f"{density}: fall below it, in spacings", (min(heights) - 0.7 + draught) / 0.04, -1e-6, 1e-6)
    test.band(f"{density}: drift of the water's volume", max(map(abs, result["water.volume_drift"])), 0, 1e-6)

fall = {**COARSE, "End time": "0.7"}
one, two = test.run(CASE, fall), test.run(CASE, fall, ranks=2)
test.check("fall: the verdict is OK", "verdict: OK" in one.text)
test.band("fall: the cube dives below its draught", min(one["cube.centre.y [m]"]), 0.45, 0.58)
test.band("fall: it comes up again", one["cube.velocity.y [m/s]"][-1], 0.1, 1)
test.band("fall: drift of the water's volume", max(map(abs, one["water.volume_drift"])), 0, 0.03)
test.agree("fall: height on 1 and 2 ranks", one["cube.centre.y [m]"][-1], two["cube.centre.y [m]"][-1], 1e-7)

space = {"Output/Particle format": "none", "Bodies/cube/Free directions": "y", "End time": "0.4",
         "Bodies/cube/Mesh/Lower corner": "0.3, 0.3, 0.3", "Bodies/cube/Mesh/Upper corner": "0.5, 0.5, 0.5"}
result = test.run("falling_cube/space.prm", space)
test.check("space: the verdict is OK", "verdict: OK" in result.text)
heights = result["cube.centre.y [m]"]
test.band("space: rise over the draught's height, in spacings", (max(heights) - 0.4) / 0.04, -1e-3, 1e-3)
test.band("space: fall below it, in spacings", (min(heights) - 0.4) / 0.04, -1e-3, 1e-3)
test.band("space: drift of the water's volume", max(map(abs, result["water.volume_drift"])), 0, 1e-5)
test.band("space: solutions that did not converge", result["water.pressure.unconverged"][-1], 0, 0)
deep = {"Output/Particle format": "none", "End time": "0.6", "Checkpoint/Interval in steps": 20,
        "Checkpoint/Number kept": 100}
result = test.run("falling_cube/space.prm", deep)
test.check("space, fall: the verdict is OK", "verdict: OK" in result.text)
test.band("space, fall: the cube dives below its draught", min(result["cube.centre.y [m]"]), 0.25, 0.32)
test.band("space, fall: it comes up again", result["cube.velocity.y [m/s]"][-1], 0.1, 1)
test.band("space, fall: drift of the water's volume", max(map(abs, result["water.volume_drift"])), 0, 0.02)
continues(result, "falling_cube/space.prm", deep, "space, fall")

# As fluid of a high viscosity it falls as the rigid body does to which water sticks, and keeps its size; on two ranks, and
# after a restart, alike.
stuck = test.run(CASE, {**fall, "Bodies/water/Structures": "stick"})
solid = {"Bodies/water/Spacing": "40 mm", "End time": "0.7", "Checkpoint/Interval in steps": 20,
         "Checkpoint/Number kept": 100}
viscous = test.run("falling_cube/viscous.prm", solid)
test.check("viscous: the verdict is OK", "verdict: OK" in viscous.text)
test.band("viscous: lowest over that of the rigid body, in spacings",
          (min(viscous["water.cube.centre.y [m]"]) - min(stuck["cube.centre.y [m]"])) / 0.04, -0.25, 0.25)
volumes = [volume / 0.04 - 1 for volume in viscous["water.cube.volume [m^2]"]]
test.band("viscous: change of its volume", max(map(abs, volumes)), 0, 0.005)
test.band("viscous: solutions that did not converge",
          viscous["water.viscosity.unconverged"][-1] + viscous["water.pressure.unconverged"][-1], 0, 0)
across = test.run("falling_cube/viscous.prm", solid, ranks=2)
test.agree("viscous: height on 1 and 2 ranks", viscous["water.cube.centre.y [m]"][-1],
           across["water.cube.centre.y [m]"][-1], 1e-7)
continues(viscous, "falling_cube/viscous.prm", solid, "viscous")

deep = test.run("falling_cube/viscous_space.prm", {"Output/Particle format": "none", "End time": "0.35"})
test.check("viscous in space: the verdict is OK", "verdict: OK" in deep.text)
test.band("viscous in space: fallen", 0.6 - deep["water.cube.centre.y [m]"][-1], 0.24, 0.3)
volumes = [volume / 0.008 - 1 for volume in deep["water.cube.volume [m^3]"]]
test.band("viscous in space: change of its volume", max(map(abs, volumes)), 0, 0.005)
test.band("viscous in space: solutions that did not converge",
          deep["water.viscosity.unconverged"][-1] + deep["water.pressure.unconverged"][-1], 0, 0)

# What a user may get wrong.
for entry, value, message in (("Regions/cube/Density", "-500", "is not positive"),
                              ("Regions/cube/Viscocity", "1e5", "did you mean 'Viscosity'?"),
                              ("Regions/cube/Upper corner", "0.7, 1.9", "a body lies outside the box"),
                              ("Structures", "slip", "does not slip on structures")):
    refused = test.run("falling_cube/viscous.prm", {f"Bodies/water/{entry}": value}, options=("--check",), exit_code=2)
    test.check(f"viscous: {entry} = {value} is refused", message in refused.text)
test.finish()
