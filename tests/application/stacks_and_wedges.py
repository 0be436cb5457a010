# SPDX-License-Identifier: GPL-3.0-or-later
"""No particle passes in a few of the small scenes of folds, junctions, slivers, thin and turning sheets."""
from run_case import Test

test = Test()
for scene in ("sharp_folds", "junction", "slivers", "thin_plate", "paddle", "impact_3000_09", "space_junction"):
    result = test.run(f"stacks_and_wedges/{scene}.prm", exit_code=None)
    test.check(f"{scene}: no particle passes", max(result["penetrations"]) == 0)
    test.check(f"{scene}: there is contact", max(result["contacts"]) > 0)
test.finish()
