# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs on other numbers of ranks: the first hundred steps in contact agree to 1e-10, and with Reproducible = true all
statistics agree in every digit, also through adaptivity, friction and a restart on other ranks."""

import shutil

from run_case import Test

# Of the ranks themselves, or differences of numbers that are nearly alike and how an iteration ended.
OF_RANKS = {"imbalance [1]", "imbalance"}
NOT_COMPARED = ("balance_error", "residual", "violation", "worst_gap")


def rows(result):
    """Lines of the file without what is of the ranks."""
    with open(result.directory / "statistics.csv") as file:
        lines = [line.rstrip("\n").split(",") for line in file]
    kept = [i for i, name in enumerate(lines[0]) if name.strip() not in OF_RANKS]
    return [[line[i] for i in kept] for line in lines]


def largest_difference(first, other):
    """Over a hundred steps from the first contact, each column over its largest value, and vectors over theirs."""
    steps, contacts = first["step"], first["contacts"]
    begin = next(i for i, n in enumerate(contacts) if n > 0)
    end = max(i for i, step in enumerate(steps) if step <= steps[begin] + 100)
    scales = {}
    for name, values in first.columns.items():
        what = name.split(" ")[0].removesuffix(".x").removesuffix(".y").removesuffix(".z")
        scales[what] = max([scales.get(what, 1e-300), *map(abs, values[:end + 1])])
    worst = 0
    for name, values in first.columns.items():
        what = name.split(" ")[0].removesuffix(".x").removesuffix(".y").removesuffix(".z")
        if name.strip() in OF_RANKS or any(word in name for word in NOT_COMPARED):
            continue
        # A block that does not turn: its angular momentum is round-off.
        scale = scales[what] if "angular" not in name else max(scales[what], 1)
        worst = max(worst, max(abs(a - b) for a, b in zip(values[:end + 1], other.columns[name])) / scale)
    return worst


test = Test()
quiet = {"Output/Particle format": "none", "Output/Structures": "false"}
plate = {**quiet, "End time": "3 ms", "Output/Statistics interval": "0.05 ms"}
first = test.run("folded_plate/folded_plate.prm", plate)
for ranks in (2, 3):
    other = test.run("folded_plate/folded_plate.prm", plate, ranks=ranks)
    difference = largest_difference(first, other)
    test.check(f"a hundred steps in contact on {ranks} ranks differ by {difference:.2g}, at most 1e-10", difference < 1e-10)

wedge = {**quiet, "Reproducible": "true", "Contact/Friction": 0.1, "Grid/Cell size": "40 mm", "End time": "5 ms",
         "Bodies/water/Particle spacing": "10 mm", "Output/Statistics interval": "0.05 ms"}
adaptive = {**quiet, "Reproducible": "true", "End time": "2 ms", "Output/Statistics interval": "0.05 ms"}
for case, values in (("folded_plate/folded_plate.prm", {**plate, "Reproducible": "true"}),
                     ("water_entry/water_entry.prm", wedge),
                     ("water_entry_3d/adaptive.prm", adaptive)):
    one = rows(test.run(case, values))
    for ranks in (2, 4):
        test.check(f"{case}: statistics on {ranks} ranks are those on one",
                   rows(test.run(case, values, ranks=ranks)) == one)

# Stopped on three ranks half-way, continued on one.
values = {**wedge, "Checkpoint/Interval in steps": 30, "Checkpoint/Number kept": 100}
whole = test.run("water_entry/water_entry.prm", values, ranks=3)
for checkpoint in sorted((whole.directory / "checkpoints").glob("step_*"))[2:]:
    shutil.rmtree(checkpoint)
expected = rows(whole)
rest = test.run("water_entry/water_entry.prm", values, options=("--restart",), directory=whole.directory)
test.check("it was continued", "step 60," in rest.text)
test.check("continued on one rank, all statistics are those of three", rows(rest) == expected)
test.finish()
