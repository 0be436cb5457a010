# SPDX-License-Identifier: GPL-3.0-or-later
"""Structures meet: two bars exchange their velocities, a ring is crushed until it lies on itself."""
import math

from run_case import Test

test = Test()
speed = math.sqrt(70e9 / 2700)
stress, duration = 2700 * speed, 2 / speed
one = test.run("colliding_bars/colliding_bars.prm")
three = test.run("colliding_bars/colliding_bars.prm", ranks=3)

time = one["time [s]"]
pressure = [force / 0.02 / stress for force in one["bar.contact_force.x [N]"]]
plateau = [p for t, p in zip(time, pressure) if 0.1 * duration < t < 0.9 * duration]
loaded = [t for t, p in zip(time, pressure) if p > 0.5]
test.band("stress over rho c v", sum(plateau) / len(plateau), 0.999, 1.001)
test.band("contact lasts 2L/c times", loaded[-1] / duration, 0.99, 1.01)
test.band("velocity of the struck bar [m/s]", one["bar.velocity.x [m/s]"][-1], 1.98, 2.0)
test.band("energy balance", max(abs(e) for e in one["energy.balance_error"]), 0, 1e-12)
momentum = one["momentum.x [kg m/s]"]
test.band("momentum drift", (max(momentum) - min(momentum)) / momentum[0], 0, 1e-12)
test.check("nothing passes", max(one["penetrations"]) == 0)
test.agree("on one and three ranks", one["bar.velocity.x [m/s]"][-1], three["bar.velocity.x [m/s]"][-1], 1e-9)

ring = test.run("crushed_ring/crushed_ring.prm")
start = ring["upper.centre.y [m]"][0]
force, approach = [], []
for upper, lower, centre in zip(ring["upper.contact_force.y [N]"], ring["lower.contact_force.y [N]"],
                                ring["upper.centre.y [m]"]):
    if 0.003 < start - centre < 0.005:
        force.append((upper - lower) / 2)
        approach.append(start - centre)
stiffness = 1e6 * 0.01**3 / 12 / (0.1488 * 0.045**3)
test.band("force over that of a thin ring", sum(force) / sum(approach) / stiffness, 0.87, 1)
test.band("contacts when the inside lies on itself", ring["contacts"][-1], 120, 300)
test.band("deepest contact [m]", min(ring["worst_gap [m]"]), -1e-6, 1)
test.band("energy balance", max(abs(e) for e in ring["energy.balance_error"]), 0, 1e-9)
test.check("nothing passes", max(ring["penetrations"]) == 0)
test.check("the solver converged in every step", max(ring["unconverged_contact_steps"]) == 0)
test.finish()
