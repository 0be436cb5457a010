# SPDX-License-Identifier: GPL-3.0-or-later
"""A wedge that falls into water slows down and is pushed as measured and as theory says, in the plane and in space."""
from run_case import Test

MASS, SPEED, GRAVITY = 241.0, 6.15, 9.81
# Zhao & Faltinsen (1993), table 1, 30 degrees: F = 14.139 rho V^3 t on the wedge at constant speed V.
SIMILARITY = 14.139
# Zhao, Faltinsen & Aarsnes (1996), figure 15, read off: time [s], speed [m/s].
MEASURED = [(0, 6.15), (2.5e-3, 6.14), (5e-3, 6.08), (7.5e-3, 5.97), (10e-3, 5.80), (12.5e-3, 5.58), (15e-3, 5.35)]


def theory(time, n_steps=2000):
    """Speed of free fall with the added mass of the similarity solution: d/dt((M + k s^2) V) = M g."""
    depth, k, dt = 0.0, 0.5 * SIMILARITY * 1000, time / n_steps
    for i in range(n_steps):
        momentum = MASS * (SPEED + GRAVITY * (i + 0.5) * dt)
        middle = depth + 0.5 * dt * momentum / (MASS + k * depth**2)
        depth += dt * momentum / (MASS + k * middle**2)
    return MASS * (SPEED + GRAVITY * time) / (MASS + k * depth**2)


def impulse(result, begin, end):
    """Of the water on the wedge [N s]: rows hold the mean force since the row before."""
    times, forces = result["time [s]"], result["wedge.contact_force.y [N]"]
    return sum(
        force * max(0.0, min(end, t1) - max(begin, t0))
        for t0, t1, force in zip(times, times[1:], forces[1:])
    )


def check_soundness(test, result):
    test.check("no particle passes", max(result["penetrations"]) == 0)
    test.check("no particle is lost", min(result["particles"]) == max(result["particles"]))
    test.check("the verdict is OK", "verdict: OK" in result.text)


def main():
    test = Test()
    no_pictures = {"Output/Particle format": "none", "Output/Structures": "false"}

    wedge = test.run("water_entry/water_entry.prm", no_pictures)
    check_soundness(test, wedge)
    for time, measured in MEASURED[1:]:
        least, most = sorted((measured, theory(time)))
        speed = -wedge.at(time, "wedge.velocity.y [m/s]")
        test.band(f"speed at {1000 * time:g} ms", speed, least - 0.1, most + 0.1)
    means = [(impulse(wedge, t * 1e-4, t * 1e-4 + 1e-3) / 1e-3, t * 1e-4 + 5e-4) for t in range(230)]
    test.band("peak force, mean over 1 ms", max(means)[0], 25e3, 33e3)
    test.band("its time", max(means)[1], 14.5e-3, 17.5e-3)

    short = dict(no_pictures, **{"End time": "6 ms"})
    name = "wedge.velocity.y [m/s]"
    for n in ("4", "1"):
        other = test.run("water_entry/water_entry.prm", dict(short, **{"Bodies/wedge/Mesh/Subdivisions": n}))
        test.agree(f"speed with {3 * int(n) ** 2} elements", other.at(5e-3, name), wedge.at(5e-3, name), 1e-6)
    parallel = test.run("water_entry/water_entry.prm", short, ranks=2)
    test.agree("speed on 2 ranks", parallel.at(5e-3, name), wedge.at(5e-3, name), 1e-6)

    slab = test.run("water_entry_3d/water_entry_3d.prm", dict(no_pictures, **{"End time": "5 ms"}))
    check_soundness(test, slab)
    test.agree("speed in space", slab.at(4.9e-3, name), wedge.at(4.9e-3, name), 0.02)

    constant = test.run("water_entry/constant_speed.prm", dict(no_pictures, **{"End time": "8 ms"}))
    check_soundness(test, constant)
    factor = impulse(constant, 3e-3, 8e-3) / (1000 * SPEED**3 * 0.5 * (8e-3**2 - 3e-3**2))
    test.band("F / (rho V^3 t)", factor, 0.95 * SIMILARITY, 1.05 * SIMILARITY)
    test.finish()


main()
