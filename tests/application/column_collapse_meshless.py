# SPDX-License-Identifier: GPL-3.0-or-later
"""The front and the height of a collapsing column of meshless water follow the measurements of Martin &
Moyce (1952), on one rank and on two alike."""
from run_case import Test

WIDTH, GRAVITY = 0.05715, 9.81
# Table 2, n^2 = 2: T = t sqrt(2 g / a), Z = x / a, for Z <= 3.
FRONT = {0.41: 1.11, 0.84: 1.22, 1.19: 1.44, 1.43: 1.67, 1.63: 1.89, 1.83: 2.11, 1.98: 2.33, 2.20: 2.56,
         2.32: 2.78, 2.51: 3.00}
# Table 6: tau = t sqrt(g / a), H = y / (2 a).
HEIGHT = {0.56: 0.94, 0.77: 0.89, 0.93: 0.83, 1.08: 0.78, 1.28: 0.72, 1.46: 0.67, 1.66: 0.61, 1.84: 0.56,
          2.00: 0.50, 2.21: 0.44, 2.45: 0.39, 2.70: 0.33, 3.06: 0.28}

test = Test()
CASE = "column_collapse_meshless/column_collapse_meshless.prm"
result = test.run(CASE, {"Output/Particle format": "none"})
test.check("the verdict is OK", "verdict: OK" in result.text)
# The clock of the experiment starts when the diaphragm has burnt: at most 0.15 is free.
front = [result.at((T - 0.15) * (WIDTH / GRAVITY / 2) ** 0.5, "water.highest.x [m]") / WIDTH / Z - 1
         for T, Z in FRONT.items()]
height = [result.at(tau * (WIDTH / GRAVITY) ** 0.5, "water.highest.y [m]") / WIDTH / 2 / H - 1
          for tau, H in HEIGHT.items()]
test.band("front, largest error", max(map(abs, front)), 0, 0.08)
test.band("height, largest error", max(map(abs, height)), 0, 0.07)
test.band("volume drift", max(map(abs, result["water.volume_drift"])), 0, 0.01)

some = {"Output/Particle format": "none", "End time": "0.12", "Bodies/water/Spacing": "2.8575 mm"}
one, two = test.run(CASE, some), test.run(CASE, some, ranks=2)
for column in ("water.centre.x [m]", "water.highest.x [m]", "water.points", "water.elements"):
    test.agree(f"1 and 2 ranks: {column}", one[column][-1], two[column][-1], 1e-9)
test.finish()
