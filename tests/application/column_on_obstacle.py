# SPDX-License-Identifier: GPL-3.0-or-later
"""Water reaches an elastic obstacle when it should and bends it as nine other codes do; ranks agree."""
from run_case import Test

test = Test()
tip = "obstacle.tip.displacement.x [m]"
coarse = {"Grid/Cell size": "8 mm", "Bodies/water/Particle spacing": "4 mm", "End time": "0.265"}
one = test.run("column_on_obstacle/column_on_obstacle.prm", coarse)
two = test.run("column_on_obstacle/column_on_obstacle.prm", coarse, ranks=2)

onset = next(t for t, u in zip(one["time [s]"], one[tip]) if u > 0.002)
peak = max(one[tip])
test.band("the corner has moved 2 mm at [s]", onset, 0.145, 0.165)
test.band("largest displacement [m]", peak, 0.041, 0.049)
test.band("at [s]", one["time [s]"][one[tip].index(peak)], 0.217, 0.260)
test.band("energy balance", one["energy.balance_error"][-1], -0.1, 0.02)
for result in (one, two):
    test.check("no particle passes", max(result["penetrations"]) == 0)
    test.check("no particle is lost", min(result["particles"]) == max(result["particles"]))
test.agree("peak on one and two ranks", peak, max(two[tip]), 0.02)
test.finish()
