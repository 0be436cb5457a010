# SPDX-License-Identifier: GPL-3.0-or-later
"""A jet's mean force on a plate is rho Q U sin(alpha) within 3 % at 90 and 60 degrees."""
import math

from run_case import Test

test = Test()
coarse = {"Grid/Cell size": "20 mm", "Bodies/water/Particle spacing": "10 mm"}
for case, alpha in (("jet_on_plate", 90), ("oblique", 60)):
    result = test.run(f"jet_on_plate/{case}.prm", coarse)
    turn = math.radians(90 - alpha)
    force = [math.sin(turn) * x - math.cos(turn) * y
             for t, x, y in zip(result["time [s]"], result["plate.contact_force.x [N]"],
                                result["plate.contact_force.y [N]"]) if t > 0.1]
    exact = 1000 * 0.1 * 5 * 5 * math.sin(math.radians(alpha))
    test.band(f"{alpha} degrees: mean force over rho Q U sin(alpha)", sum(force) / len(force) / exact, 0.97, 1.03)
    test.check("no particle goes through", max(result["penetrations"]) == 0)
test.finish()
