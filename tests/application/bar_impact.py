# SPDX-License-Identifier: GPL-3.0-or-later
"""A bar of material points strikes one of elements: stress rho c v for 2L/c, momentum is exchanged."""
import math

from run_case import Test

test = Test()
speed = math.sqrt(70e9 / 2700)
stress, duration = 2700 * speed, 2 / speed
one = test.run("bar_impact/bar_impact.prm")
two = test.run("bar_impact/bar_impact.prm", ranks=2)

time = one["time [s]"]
pressure = [force / 0.02 / stress for force in one["bar.contact_force.x [N]"]]
plateau = [p for t, p in zip(time, pressure) if 0.1 * duration < t < 0.9 * duration]
loaded = [t for t, p in zip(time, pressure) if p > 0.5]
test.band("stress over rho c v", sum(plateau) / len(plateau), 0.99, 1.01)
test.band("contact lasts 2L/c times", loaded[-1] / duration, 0.98, 1.02)
test.band("velocity of the struck bar [m/s]", one["bar.velocity.x [m/s]"][-1], 1.96, 2.02)
test.band("energy balance", one["energy.balance_error"][-1], -0.01, 0.01)
momentum = one["momentum.x [kg m/s]"]
test.band("momentum drift", (max(momentum) - min(momentum)) / momentum[0], 0, 1e-12)
test.check("no particle passes", max(one["penetrations"]) == 0)
test.agree("on one and two ranks", one["bar.velocity.x [m/s]"][-1], two["bar.velocity.x [m/s]"][-1], 1e-6)

wall = test.run("bar_impact/on_wall.prm")
pressure = [force / 0.02 / stress for force in wall["wall.contact_force.x [N]"]]
plateau = [p for t, p in zip(wall["time [s]"], pressure) if 0.1 * duration < t < 0.9 * duration]
test.band("stress on a wall over rho c v", sum(plateau) / len(plateau), 0.99, 1.01)
test.band("rebound [m/s]", wall["striker.velocity.x [m/s]"][-1], -1.01, -0.96)
test.finish()
