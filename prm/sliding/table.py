#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Speed that frictionless sliding loses, for each local search, as a table.

    prm/sliding/table.py build/release/coracle [-o FOLDER]

Searches that the program does not have are left out.
"""
import argparse
import csv
import math
import pathlib
import subprocess

HERE = pathlib.Path(__file__).resolve().parent
SEARCHES = ("nearest on surface", "nearest per facet", "perpendicular foot")
CASES = (
    ("particle, flat", "sliding.prm", {}),
    ("block, flat", "block.prm", {}),
    ("particle, cylinder, steps of 20 us", "cylinder.prm", {"Time/Largest step": "20 us"}),
    ("particle, cylinder, 10 us", "cylinder.prm", {}),
    ("particle, cylinder, 5 us", "cylinder.prm", {"Time/Largest step": "5 us"}),
)


def read(folder):
    with open(pathlib.Path(folder) / "statistics.csv", newline="") as file:
        rows = list(csv.reader(file))
    return {name: [float(row[i]) for row in rows[1:]] for i, name in enumerate(rows[0])}


def result(folder, case):
    """Facets passed, and the share of the speed lost."""
    table = read(folder)
    x, y = table["slider.centre.x [m]"], table["slider.centre.y [m]"]
    u, v = table["slider.velocity.x [m/s]"], table["slider.velocity.y [m/s]"]
    if case != "cylinder.prm":
        return (x[-1] - x[0]) / 0.01, 1 - u[-1] / u[0]
    turn = sum(math.remainder(math.atan2(y[i + 1], x[i + 1]) - math.atan2(y[i], x[i]), 2 * math.pi)
               for i in range(len(x) - 1))
    # Speed where it started, over the middle of a facet: mean of the fastest of the last round.
    last = sorted(math.hypot(a, b) for a, b in zip(u[-30:], v[-30:]))
    return turn / (2 * math.pi) * 40, 1 - sum(last[-5:]) / 5 / math.hypot(u[0], v[0])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("-o", "--output", default="output/sliding")
    arguments = parser.parse_args()
    text = subprocess.run([arguments.program, "--print-parameters=markdown"], stdout=subprocess.PIPE,
                          text=True, check=True).stdout
    line = next(part for part in text.split("## `Contact`")[1].splitlines() if "| `Local search` |" in part)
    print("| local search | case | facets passed | share of the speed lost |\n|---|---|---|---|")
    for search in (word for word in SEARCHES if word in line):
        for title, case, values in CASES:
            folder = pathlib.Path(arguments.output) / f"{search}, {title}".replace(" ", "_")
            command = [arguments.program, str(HERE / case), "--set", f"Output/Directory={folder}",
                       "--set", f"Contact/Local search={search}"]
            for entry, value in values.items():
                command += ["--set", f"{entry}={value}"]
            subprocess.run(command, stdout=subprocess.DEVNULL)
            n_facets, loss = result(folder, case)
            print(f"| {search} | {title} | {n_facets:.0f} | {loss:.2g} |", flush=True)


if __name__ == "__main__":
    main()
