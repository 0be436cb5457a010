#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What goes wrong in a run is named with its place and time at most one step later, on any number of
ranks: numbers that are none, an element that is turned inside out, a step that collapses, energy from
nowhere. Each ends the run with FAILED, and results up to there. (Lost particles: tests/grid/migration.)"""
import pathlib
import re

from run_case import Test

test = Test()

CASE = """
set Dimension = 2
set End time  = 20 ms
set Gravity   = 0, -9.81
subsection Grid
  set Upper corner = 1, 1
  set Cell size    = 50 mm
end
subsection Materials
  subsection water
    set Model       = weakly compressible
    set Sound speed = 30 m/s
  end
  subsection rubber
    set Model         = neo-Hookean
    set Density       = 1000
    set Young modulus = 1 MPa
    set Poisson ratio = 0.3
  end
end
subsection Bodies
  subsection water
    set Material         = water
    set Upper corner     = 0.5, 0.3
    set Particle spacing = 25 mm
    set Body force       = {force}
    set Initial velocity = {velocity}
  end
  subsection block
    set Kind     = solid
    set Material = rubber
    subsection Mesh
      set Type         = box
      set Lower corner = 0.7, 0.5
      set Upper corner = 0.9, 0.7
      set Subdivisions = 4, 4
    end
    subsection Loads
      subsection pull
        set Type     = acceleration
        set Acceleration = {pull}
      end
    end
  end
  subsection ball
    set Kind             = rigid
    set Mass             = 1
    set Free directions  = none
    set Motion           = velocity
    set Velocity         = {motion}
    subsection Mesh
      set Type         = box
      set Lower corner = 0.2, 0.7
      set Upper corner = 0.3, 0.8
      set Subdivisions = 2, 2
    end
  end
end
subsection Output
  set Statistics interval in steps = 1
end
"""
SOUND = {"force": "0; 0", "velocity": "0, 0", "pull": "0; 0", "motion": "0; 0"}
AFTER = "if(t > 0.0051, {0}, 0)"


def fails(name, title, place, changes=None, values=None, latest=None):
    file = pathlib.Path.cwd() / f"{name}.prm"
    file.write_text(CASE.format(**{**SOUND, **(changes or {})}))
    for ranks in (1, 2):
        result = test.run(str(file), values, ranks, exit_code=3)
        what = f"{name} on {ranks} ranks"
        test.check(f"{what}: FAILED, {title}", re.search(f"verdict: FAILED\n  - {title}", result.text))
        found = re.search(r"found +(.*)", result.text)
        test.check(f"{what}: {found and found[1]}", found and re.search(place, found[1]))
        if latest:
            test.check(f"{what}: at most one step late", result["time [s]"][-1] <= latest)


DT = 1.1e-3
fails("particle", ".*", r"particle \d+ of 'water' at \(.*\) m, t = 0\.00[56]",
      {"force": AFTER.format("0/0") + "; 0"}, latest=0.0051 + 2 * DT)
fails("particle_infinite", ".*", r"particle \d+ of 'water'", {"force": "0; " + AFTER.format("1/0")},
      latest=0.0051 + 2 * DT)
fails("node", "place of a node that is not a number", r"'block': element \d+ of \d+ .* \(0\.\d+ 0\.\d+\)",
      {"pull": AFTER.format("0/0") + "; 0"}, latest=0.0051 + 2 * DT)
fails("inverted", "element turned inside out", r"'block': element \d+ of \d+ on this rank, at \(",
      {"pull": "if(x > 0.85, -1e6, 1e6); 0"})
fails("rigid", "the motion of a rigid body is not a number", r"'ball': t = 0\.00[56]",
      {"motion": AFTER.format("0/0") + "; 0"}, latest=0.0051 + 2 * DT)
fails("step", "the time step has collapsed", r"'water' asks for it, whose fastest particle is number \d+",
      {"force": AFTER.format("1e8") + "; 0"}, {"Time/Smallest share": 0.5, "Time/Largest step": "0.01 ms"})
fails("energy", "the energy balance is lost", r"of the largest energy at t = 0\.\d+ s, step \d+",
      {"velocity": "5, 0"}, {"Output/Verdict/Energy error that ends the run": 1e-6})
test.finish()
