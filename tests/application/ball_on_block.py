# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh that becomes finer in front of a ball: nothing passes, the rebound is that of a mesh which is
fine from the start, and a run that goes on from a checkpoint in between is the same bit by bit on as
many ranks, and to round-off on others.
"""
import json
import shutil

from run_case import Test

test = Test()
case = "ball_on_block/ball_on_block.prm"
# Contact that does not depend on the order in which it is solved.
exact = {"Contact/Tolerance": 1e-12, "Contact/Maximum iterations": 100000}


def manifest(checkpoint):
    return json.loads((checkpoint / "manifest.json").read_text())["contents"]


def state(checkpoint):
    files = manifest(checkpoint)["files"]
    return {name: files[name] for name in files if name != "parameters.prm"}


def checkpoints(directory):
    return sorted((directory / "checkpoints").glob("step_*"))


def cut_after(directory, step):
    """A copy of a run as it was when it was killed after the checkpoint of this step."""
    copy = test.new_directory(case)
    shutil.copytree(directory, copy)
    for checkpoint in checkpoints(copy):
        if manifest(checkpoint)["step"] > step:
            shutil.rmtree(checkpoint)
    return copy


adaptive, fine, coarse = (test.run(f"ball_on_block/{name}.prm") for name in ("ball_on_block", "fine", "coarse"))
speeds = [run["ball.velocity.y [m/s]"][-1] for run in (coarse, adaptive, fine)]
test.check("no node passes", max(adaptive["penetrations"]) == 0)
test.band("ball turns back [m/s]", speeds[1], 5, 12)
test.check(f"as with the fine mesh ({speeds[0]:.4g} coarse, {speeds[1]:.4g}, {speeds[2]:.4g} fine)",
           abs(speeds[1] - speeds[2]) < 0.3 * abs(speeds[0] - speeds[2]) + 0.02)
test.band("energy balance", max(map(abs, adaptive["energy.balance_error"])), 0, 0.02)

for ranks in (1, 2):
    values = {"End time": "20 ms", "Checkpoint/Interval in steps": 30, "Checkpoint/Number kept": 100}
    whole = test.run(case, values, ranks).directory
    steps = [manifest(c)["step"] for c in checkpoints(whole)]
    copy = cut_after(whole, steps[len(steps) // 3])
    test.run(case, values, ranks, ["--restart"], 0, copy)
    name = f"on {ranks} ranks, from step {steps[len(steps) // 3]} of {steps[-1]}"
    test.check(f"{name}: the statistics are the same",
               (whole / "statistics.csv").read_bytes() == (copy / "statistics.csv").read_bytes())
    test.check(f"{name}: the states are the same",
               all(state(c) == state(copy / "checkpoints" / c.name) for c in checkpoints(whole)))

values = {"End time": "14 ms", "Checkpoint/Interval in steps": 30, "Checkpoint/Number kept": 100, **exact}
whole = test.run(case, values, 1)
for ranks in (2, 3):
    steps = [manifest(c)["step"] for c in checkpoints(whole.directory)]
    copy = cut_after(whole.directory, steps[-3])
    after = test.run(case, values, ranks, ["--restart"], 0, copy)
    worst = max(abs(a - b) for column in ("ball.velocity.y [m/s]", "under.position.y [m]")
                for a, b in zip(whole[column if column in whole.columns else "block." + column],
                                after[column if column in after.columns else "block." + column]))
    test.check(f"continued on {ranks} ranks: velocity and place agree to {worst:.2g}", worst < 1e-9)
test.finish()
