# SPDX-License-Identifier: GPL-3.0-or-later
"""Grids that adapt give what uniform ones do for fewer particle-steps, on any number of ranks, and keep water at rest."""
from run_case import Test


def check_soundness(test, result):
    test.check("no particle passes", max(result["penetrations"]) == 0)
    test.check("the verdict is OK", "verdict: OK" in result.text)
    books = [result[f"particles.{name}"][-1] for name in ("created", "split", "removed", "converted", "merged")]
    left = books[0] + books[1] - books[2] - books[3] - books[4]
    test.check(f"the ledger is closed: {left:.0f} particles", left == result["particles"][-1])


def main():
    test = Test()
    short = {"Output/Particle format": "none", "Output/Structures": "false", "End time": "6 ms"}
    name = "wedge.velocity.y [m/s]"
    fine = test.run("water_entry/water_entry.prm", short)
    adaptive = test.run("adaptive_study/water_entry.prm", short)
    check_soundness(test, adaptive)
    test.check("particles split", adaptive["particles"][-1] > adaptive["particles"][0])
    test.band("particle-steps, over those of uniform cells of 20 mm",
              adaptive["particle_steps"][-1] / fine["particle_steps"][-1], 0.0, 1.0)
    # Drop test and theory, 5 ms: 6.08 and 6.03 m/s.
    test.band("speed at 5 ms", -adaptive.at(5e-3, name), 5.98, 6.13)
    parallel = test.run("adaptive_study/water_entry.prm", short, ranks=3)
    check_soundness(test, parallel)
    test.agree("speed on 3 ranks", parallel.at(5e-3, name), adaptive.at(5e-3, name), 1e-6)
    test.check("the same cells on 3 ranks", parallel["cells"] == adaptive["cells"])
    test.band("imbalance", max(parallel["imbalance"][1:]), 1.0, 1.2)

    # The verdict compares what GIMP makes up with the energy of water at rest, which is next to nothing.
    still = {"Output/Particle format": "none", "End time": "0.6", "Bodies/water/Shape functions": "gimp"}
    unchanged = test.run("hydrostatic/at_rest.prm", still, exit_code=None)
    water = test.run("hydrostatic/cycles.prm", still, exit_code=None)
    test.check("no particle is lost", water["particles"][-1] == water["particles"][0])
    name = "energy.balance_error"
    test.band("energy from nowhere, more than without cycles", water[name][-1] - unchanged[name][-1], -0.005, 0.005)
    test.check("cells were refined and coarsened",
               max(water["cells"]) > 4 * water["cells"][0] and water["cells"][-1] == water["cells"][0])
    mass = water["water.mass [kg]"][0]
    speeds = [(2 * energy / mass) ** 0.5 for energy in water["energy.kinetic [J]"]]
    test.band("root mean square of the water's speed [m/s]", max(speeds), 0, 2e-4)
    test.finish()


main()
