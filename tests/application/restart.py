#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A run that goes on from a checkpoint equals one that never stopped: on as many ranks bit by bit, in
results and in the whole state more than 200 steps later; on other ranks to round-off.

The cases have contact with friction (a folded sheet with water on it), a free rigid body, elastic bars that
meet, a sheet that moves, and an octree that adapts.
"""
import json
import pathlib
import shutil

from run_case import Test

test = Test()


def manifest(checkpoint):
    return json.loads((checkpoint / "manifest.json").read_text())["contents"]


def state(checkpoint):
    """Sizes and checksums of the files that hold the state: not of the parameters, which name the
    folder."""
    files = manifest(checkpoint)["files"]
    return {name: files[name] for name in files if name != "parameters.prm"}


def checkpoints(directory):
    return sorted((directory / "checkpoints").glob("step_*"))


def stop_at(directory, case, step):
    """A copy of a run as it was when it was killed after the checkpoint of this step."""
    copy = test.new_directory(case)
    shutil.copytree(directory, copy)
    for checkpoint in checkpoints(copy):
        if manifest(checkpoint)["step"] > step:
            shutil.rmtree(checkpoint)
    return copy


def same_ranks(case, values, ranks, step):
    values = {"Checkpoint/Interval in steps": 50, "Checkpoint/Number kept": 100, **values}
    whole = test.run(case, values, ranks, exit_code=None).directory
    copy = stop_at(whole, case, step)
    after = test.run(case, values, ranks, ["--restart"], None, copy)
    name = f"{case} on {ranks} ranks"
    last = manifest(checkpoints(whole)[-1])
    test.check(f"{name}: {last['step'] - step} steps after step {step}", last["step"] - step >= 200)
    test.check(f"{name}: it was continued there", f"step {step}," in after.text)
    test.check(f"{name}: the statistics are the same",
               (whole / "statistics.csv").read_bytes() == (copy / "statistics.csv").read_bytes())
    for checkpoint in checkpoints(whole):
        if not test.check(f"{name}: the state of {checkpoint.name} is the same",
                          state(checkpoint) == state(copy / "checkpoints" / checkpoint.name)):
            break
    for listing in [*whole.glob("*.pvd"), *whole.glob("*.xdmf")]:
        test.check(f"{name}: {listing.name} is the same",
                   listing.read_bytes() == (copy / listing.name).read_bytes())
    return whole


def other_ranks(case, values, before, after, step, tolerance=1e-12):
    """Rows of a continuation on other ranks against those of the run itself, relative to the largest
    value of the same unit."""
    values = {"Checkpoint/Interval in steps": step, "Output/Statistics interval in steps": 1,
              # So that contact does not depend on the order in which it is solved.
              "Contact/Tolerance": 1e-13, "Contact/Maximum iterations": 100000, **values}
    whole = test.run(case, values, before, exit_code=None)
    copy = stop_at(whole.directory, case, step)
    result = test.run(case, values, after, ["--restart"], None, copy)
    name = f"{case} saved by {before}, continued by {after} ranks"
    test.check(f"{name}: {len(whole['step'])} rows", result["step"] == whole["step"])
    unit = lambda column: column[column.rindex("["):] if "[" in column else column
    scales = {"[rad/s]": 1, "[kg m^2/s]": max(map(abs, whole["momentum.y [kg m/s]"])),
              "energy.balance_error": 1}
    for column in whole.columns:
        if unit(column) not in ("[rad/s]", "[kg m^2/s]", "energy.balance_error"):
            scales[unit(column)] = max(1e-300, scales.get(unit(column), 0),
                                       *map(abs, whole[column]))
    # Forces are differences of momenta received since the start over one step: digits cancel.
    scales["[N]"] *= 100
    # What the solver tells of itself is round-off, and the balance is one of ranks.
    own = ("contact.iterations", "contact.residual", "contact.worst", "imbalance", "water.pressure")
    worst = {column: max(abs(a - b) for a, b in zip(whole[column], result[column]))
             / scales[unit(column)] for column in whole.columns if not column.startswith(own)}
    column = max(worst, key=worst.get)
    test.check(f"{name}: all agree to {worst[column]:.2g} ({column})", worst[column] <= tolerance)


FRICTION = {"Bodies/plate/Friction": 0.3, "End time": "10 ms"}
for n in (1, 2):
    same_ranks("folded_plate/folded_plate.prm", FRICTION, n, 250)
    same_ranks("water_entry/water_entry.prm", {"End time": "10 ms"}, n, 200)
    same_ranks("colliding_bars/colliding_bars.prm", {}, n, 400)
    # A sheet that moves cuts other cells.
    same_ranks("stacks_and_wedges/paddle.prm", {}, n, 150)
    # Points come and go, and are shared out.
    same_ranks("column_collapse_meshless/column_collapse_meshless.prm", {"End time": "0.2"}, n, 50)
    # The octree changes on the way, particles split and merge, ranks are balanced.
    same_ranks("adaptive_study/water_entry.prm", {"End time": "6 ms"}, n, 250)

# Elements go to other ranks again and again.
OFTEN = {"Grid/Load balance/Interval in steps": 20, "Grid/Load balance/Largest imbalance": 1.001,
         "Grid/Load balance/Work of a contact": 200}
same_ranks("colliding_bars/colliding_bars.prm", {**OFTEN, "Output/Structures": "false"}, 3, 400)

# Not too many particles: their masses are added one after the other.
COARSE = {"Grid/Cell size": "40 mm", "Bodies/water/Particle spacing": "10 mm", "End time": "4.5 ms"}
for ranks in ((1, 2), (2, 1), (3, 2), (3, 4)):
    other_ranks("water_entry/water_entry.prm", COARSE, *ranks, 90)
for ranks in ((1, 2), (2, 3)):
    other_ranks("colliding_bars/colliding_bars.prm", {"End time": "0.16 ms"}, *ranks, 200)
for ranks in ((1, 4), (3, 1)):
    other_ranks("colliding_bars/colliding_bars.prm", {**OFTEN, "End time": "0.16 ms"}, *ranks, 200)
other_ranks("folded_plate/folded_plate.prm", {**FRICTION, "End time": "3.6 ms"}, 2, 1, 200)
# To the tolerance of the pressure's solver.
other_ranks("column_collapse_meshless/column_collapse_meshless.prm", {"End time": "0.1"}, 1, 2, 100, 1e-9)
test.finish()
