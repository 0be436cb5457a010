# SPDX-License-Identifier: GPL-3.0-or-later
"""Two elastic discs bounce: momentum stays zero to round-off, energy is kept, ranks agree."""
from run_case import Test

test = Test()
one = test.run("colliding_discs/colliding_discs.prm")
two = test.run("colliding_discs/colliding_discs.prm", ranks=2)

kinetic, strain = one["energy.kinetic [J]"], one["energy.internal [J]"]
speed = one["lower.velocity.x [m/s]"]
contact = next(t for t, v in zip(one["time [s]"], speed) if v < 0.099)
test.band("kinetic energy at the start [J]", kinetic[0], 2.513, 2.514)
test.band("contact at most two cells before the circles touch [s]", contact, 1.5858 - 0.1 / 0.1414, 1.5858)
test.band("kinetic energy at least [J]", min(kinetic), 0.0, 0.25)
test.band("kinetic energy recovered", kinetic[-1] / kinetic[0], 0.85, 1.0)
drift = max(abs(k + s - kinetic[0]) for k, s in zip(kinetic, strain)) / kinetic[0]
test.band("drift of kinetic and strain energy", drift, 0, 0.01)
# Each disc has 12.6 kg m/s in x.
test.band("momentum [kg m/s]", max(map(abs, one["momentum.x [kg m/s]"])), 0, 1e-11)
test.check("no particle is lost", min(one["particles"]) == max(one["particles"]))
test.agree("rebound on one and two ranks", speed[-1], two["lower.velocity.x [m/s]"][-1], 1e-9)
test.finish()
