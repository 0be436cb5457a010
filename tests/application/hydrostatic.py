# SPDX-License-Identifier: GPL-3.0-or-later
"""Water settles under its weight as far as its compressibility says, and then stays at rest, also across hanging nodes."""
from run_case import Test

GRAVITY, SOUND_SPEED, DENSITY = 9.81, 50.0, 1000.0
SETTLING = GRAVITY / (2 * SOUND_SPEED**2)  # of the surface of 1 m of water [m]


def main():
    test = Test()
    column = test.run("hydrostatic/hydrostatic.prm", {"Output/Particle format": "none"})
    heights = column["water.centre.y [m]"]
    # A point at height y sinks by g (y - y^2 / 2) / c^2: the centre by two thirds of the surface.
    test.band("the surface settles", 1.5 * (heights[0] - heights[-1]), 0.97 * SETTLING, 1.03 * SETTLING)
    # The probe is 12.5 mm above the floor.
    floor = column["water.floor.pressure [Pa]"][-1] + DENSITY * GRAVITY * 0.0125
    test.band("pressure at the floor", floor, 0.99 * DENSITY * GRAVITY, 1.01 * DENSITY * GRAVITY)
    test.check("no particle is lost", min(column["particles"]) == 640)

    rest = {}
    for ranks in (1, 2):
        rest[ranks] = test.run("hydrostatic/at_rest.prm", {"Output/Particle format": "none"}, ranks=ranks)
        result = rest[ranks]
        mass = result["water.mass [kg]"][0]
        speeds = [(2 * energy / mass) ** 0.5 for energy in result["energy.kinetic [J]"]]
        test.band("root mean square velocity of water at rest, largest", max(speeds), 0, 2.5e-4)
        test.band("and at the end", speeds[-1], 0, 5e-5)
    name = "water.centre.y [m]"
    test.agree("centre on 1 and 2 ranks", rest[1][name][-1], rest[2][name][-1], 1e-10)
    test.finish()


main()
