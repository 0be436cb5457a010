#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Particles through the folded plate for each local search, law, speed and thickness, as a table.

    prm/folded_plate/sweep.py build/release/coracle [--space] [--speeds 1,3,10,30] [-o FOLDER] [-j 2]
        [--searches "nearest on surface"] [--laws split,blended]

Every row differs from the default in one or two words of the parameter file. Searches and laws that
the program does not have are left out. Columns: crossings counted by the audit, particles below the
plate at the end, energy that contact fed in (over the energy at the start), and the highest upward speed of any particle in any output
frame over the speed of the fall. Needs python3-h5py and python3-vtk9.
"""
import argparse
import concurrent.futures
import pathlib
import subprocess
import sys

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent.parent / "contrib"))
from read_output import Output  # noqa: E402

SEARCHES = ("nearest on surface", "nearest per facet", "perpendicular foot")
LAWS = ("split", "blended", "stick/slip")
# Contact radius over spacing (half a cell), and thickness of the plate [m]: R is 0.3, 0.03 and
# 0.0005 cells, the last for points without radius on a plate of a thousandth of a cell.
SIZES = {"0.3": (0.5, 1e-3), "0.03": (0.05, 1e-4), "0.0005": (0.0, 1e-5)}
SPEEDS = (1.0, 3.0, 10.0, 30.0)
FALL = 0.2  # metres that the block would fall in a run without the plate


def available(program, entry, words):
    """Those of the words that the program accepts for an entry of Contact."""
    text = subprocess.run([program, "--print-parameters=markdown"], stdout=subprocess.PIPE, text=True,
                          check=True).stdout
    line = next(part for part in text.split("## `Contact`")[1].splitlines() if f"| `{entry}` |" in part)
    return [word for word in words if word in line]


def plate_height(x):
    """Folds of 45 degrees, 0.1 m apart, tops at 0.2 m over x = 0, 0.1, ..."""
    return 0.15 + np.abs((x / 0.1) % 1 - 0.5) * 0.1


def evaluate(folder, speed):
    output = Output(folder)
    table = output.statistics
    frames = output.series["water"]
    highest = max(frames.read(i).point_data["velocity"][:, 1].max() for i in range(len(frames.times)))
    last = frames.read(len(frames.times) - 1).points
    return {
        "crossings": int(table["penetrations"].max()),
        "below": int((last[:, 1] < plate_height(last[:, 0])).sum()),
        "fed": table["contact.energy_fed [J]"].max() / table["energy.kinetic [J]"][0],
        "rebound": highest / speed,
        "unconverged": int(table["unconverged_contact_steps"].max()),
    }


def run(program, case, folder, search, law, speed, size):
    radius, thickness = SIZES[size]
    fall = "0, -%g, 0" % speed if "3d" in case else "0, -%g" % speed
    values = {
        "Output/Directory": folder,
        "Output/Interval": FALL / speed / 10,
        "Output/Statistics interval": FALL / speed / 200,
        "Output/Log interval": FALL / speed,
        "End time": FALL / speed,
        "Contact/Local search": search,
        "Contact/Law": law,
        "Materials/water/Sound speed": max(50, 10 * speed),
        "Bodies/water/Initial velocity": fall,
        "Bodies/water/Contact radius": radius,
        "Bodies/plate/Thickness": thickness,
    }
    command = [program, str(HERE / case)]
    for entry, value in values.items():
        command += ["--set", f"{entry}={value}"]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    # 0 is OK, 1 SUSPECT; a run that broke down has its row, too.
    if not (pathlib.Path(folder) / "statistics.csv").exists():
        raise RuntimeError(done.stdout)
    result = evaluate(folder, speed)
    result["failed"] = "FAILED" in done.stdout.split("verdict:")[-1] and result["crossings"] == 0
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--space", action="store_true", help="the slab in 3-D")
    parser.add_argument("--speeds", default=",".join("%g" % v for v in SPEEDS))
    parser.add_argument("--sizes", default=",".join(SIZES))
    parser.add_argument("--searches", default=",".join(SEARCHES))
    parser.add_argument("--laws", default=",".join(LAWS))
    parser.add_argument("-o", "--output", default="output/folded_plate_sweep")
    parser.add_argument("-j", "--jobs", type=int, default=1)
    arguments = parser.parse_args()
    case = "folded_plate_3d.prm" if arguments.space else "folded_plate.prm"
    rows = [
        (search, law, float(speed), size)
        for search in available(arguments.program, "Local search", arguments.searches.split(","))
        for law in available(arguments.program, "Law", arguments.laws.split(","))
        for size in arguments.sizes.split(",")
        for speed in arguments.speeds.split(",")
    ]

    def one(row):
        folder = pathlib.Path(arguments.output) / "_".join(str(part) for part in row).replace(
            " ", "-").replace("/", "-")
        return run(arguments.program, case, str(folder), *row)

    print("| local search | law | R/h | speed [m/s] | crossings | below at the end | energy fed in [%] |"
          " highest rebound / speed | steps not converged |")
    print("|---|---|---|---|---|---|---|---|---|")
    default_is_clean = True
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        for (search, law, speed, size), result in zip(rows, pool.map(one, rows)):
            note = " (broke down)" if result["failed"] else ""
            print(f"| {search} | {law} | {size} | {speed:g}{note} | {result['crossings']} | "
                  f"{result['below']} | {100 * result['fed']:.2g} | {result['rebound']:.2f} | "
                  f"{result['unconverged']} |", flush=True)
            if (search, law) == (SEARCHES[0], LAWS[0]):
                default_is_clean &= result["crossings"] == result["below"] == 0
    sys.exit(0 if default_is_clean else 1)


if __name__ == "__main__":
    main()
