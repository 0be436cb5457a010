# SPDX-License-Identifier: GPL-3.0-or-later
"""Water on the folded plate: no particle goes through, at two thicknesses, in the plane on 1 and 2 ranks and in space."""

from run_case import Test


test = Test()
# Thin: points without radius on a plate of a thousandth of a cell, at a speed that crosses it
# several times a step.
thin = {"Bodies/water/Contact radius": 0, "Bodies/plate/Thickness": "0.01 mm",
        "Materials/water/Sound speed": 200, "End time": "5 ms"}
in_plane = {**thin, "Bodies/water/Initial velocity": "0, -20"}
in_space = {**thin, "Bodies/water/Initial velocity": "0, -20, 0"}
for case, values, ranks in (
        ("folded_plate", {"End time": "20 ms"}, 1),
        ("folded_plate", in_plane, 2),
        ("folded_plate_3d", in_space, 1)):
    result = test.run(f"folded_plate/{case}.prm", {**values}, ranks=ranks)
    test.check("no particle goes through", max(result["penetrations"]) == 0)
    test.check("water and plate meet", max(result["contacts"]) > 20)
    test.check("contact converges in every step", max(result["unconverged_contact_steps"]) == 0)
    fed = max(result["contact.energy_fed [J]"]) / result["energy.kinetic [J]"][0]
    test.check(f"energy fed in by contact, {fed:.2g}, is below 1e-4", fed < 1e-4)
test.finish()
