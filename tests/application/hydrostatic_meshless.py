# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshless water in a box stays at rest under its hydrostatic pressure, in the plane and in space."""
from run_case import Test

test = Test()
for name, values in (("plane", {}),
                     ("space", {"Dimension": 3, "Gravity": "0, 0, -9.81", "Grid/Lower corner": "0, 0, 0",
                                "Grid/Upper corner": "1, 1, 1.5", "Bodies/water/Upper corner": "1, 1, 1",
                                "Bodies/water/Spacing": "125 mm", "End time": "0.3",
                                "Probes/floor/Position": "0.5, 0.5, 0"})):
    result = test.run("hydrostatic_meshless/hydrostatic_meshless.prm", values)
    test.check(f"{name}: the verdict is OK", "verdict: OK" in result.text)
    pressure = result["water.floor.pressure [Pa]"][-1]
    test.band(f"{name}: pressure at the floor over rho g h, less 1", pressure / 9810 - 1, -1e-6, 1e-6)
    test.band(f"{name}: kinetic energy over weight times depth", max(result["energy.kinetic [J]"]) / 9810,
              0, 1e-15)
    test.band(f"{name}: volume", result["water.volume_drift"][-1], -1e-9, 1e-9)
test.finish()
