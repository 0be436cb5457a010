# SPDX-License-Identifier: GPL-3.0-or-later
"""A particle and a block that slide without friction over 1000 facets keep their speed to 1e-12; on a cylinder a particle keeps it better the shorter the steps."""
import math

from run_case import Test

test = Test()
for case in ("sliding", "block"):
    result = test.run(f"sliding/{case}.prm")
    speed, x = result["slider.velocity.x [m/s]"], result["slider.centre.x [m]"]
    test.check(f"{case}: slid over 1000 facets of 10 mm", x[-1] - x[0] > 9.999)
    test.check(f"{case}: is pressed on in every step", min(result["contacts"][1:]) > 0)
    loss = abs(speed[-1] / speed[0] - 1)
    test.check(f"{case}: relative change of speed {loss:.2g}, at most 1e-12", loss <= 1e-12)

losses = []
for step in ("40 us", "20 us"):
    result = test.run("sliding/cylinder.prm", {"Time/Largest step": step})
    last = sorted(math.hypot(u, v) for u, v in zip(result["slider.velocity.x [m/s]"][-30:],
                                                   result["slider.velocity.y [m/s]"][-30:]))
    losses.append(1 - sum(last[-5:]) / 5 / 10)
print("losses over five rounds of the cylinder:", losses)
test.band("loss with steps of 20 us", losses[1], -1e-3, 5e-3)
test.check("it is not more than with 40 us", losses[1] < losses[0])
test.finish()
