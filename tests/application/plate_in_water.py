# SPDX-License-Identifier: GPL-3.0-or-later
"""Water at rest on one side or both sides of a thin plate stays at rest and presses as it should; what passes on one side is
not felt on the other, unless the fields are not split."""
from run_case import Test

WEIGHT = 1000 * 9.81
RUN = {"End time": "0.2", "Output/Particle format": "none"}


def main():
    test = Test()
    for case, left, right in (("one_side", 0.6, 0.0), ("dam", 0.6, 0.3), ("both_sides", 0.6, 0.6)):
        for ranks in (1, 2) if case == "dam" else (1,):
            result = test.run(f"plate_in_water/{case}.prm", RUN, ranks=ranks)
            forces = [force for time, force in zip(result["time [s]"], result["plate.contact_force.x [N]"]) if time > 0.05]
            force = sum(forces) / len(forces)
            expected = WEIGHT * (left**2 - right**2) / 2
            test.band("mean force on the plate", force, expected - 0.02 * WEIGHT * 0.18, expected + 0.02 * WEIGHT * 0.18)
            mass = sum(result[f"{body}.mass [kg]"][0] for body in ("left", "right") if right > 0 or body == "left")
            speeds = [(2 * energy / mass) ** 0.5 for energy in result["energy.kinetic [J]"]]
            test.band("root mean square velocity at the end", speeds[-1], 0, 0.003)
            test.check("nothing passes", max(result["penetrations"]) == 0)

    for split in ("true", "false"):
        result = test.run("plate_in_water/passing.prm", {**RUN, "End time": "0.1", "Contact/Split fields": split},
                          # Without the split energy appears, too, and the verdict says so.
                          exit_code=0 if split == "true" else 1)
        loss = 1 - result["above.velocity.x [m/s]"][-1]
        if split == "true":
            test.band("velocity lost while passing", abs(loss), 0, 1e-12)
        else:
            test.band("velocity lost while passing, not split", loss, 0.01, 1)
    test.finish()


main()
