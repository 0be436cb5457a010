#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Front and height of the collapsing column with both fluids, over Martin & Moyce's tables and bands.

    prm/column_collapse_meshless/compare.py output/column_collapse output/column_collapse_meshless -o FILE.png

Material points pass the discs of ../column_collapse/sensors.prm, one mark for each; of the meshless
fluid the highest place is known at any time. Clocks of the front are shifted as the cases' READMEs
tell. Needs python3-matplotlib.
"""
import argparse
import json
import math
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent.parent / "contrib"))
from read_output import Output  # noqa: E402

WIDTH, GRAVITY = 0.05715, 9.81
SHIFT = {"points": 0.10, "meshless": 0.15}


def first(times, happened):
    """When it is true for the first time, or None."""
    return next((t for t, yes in zip(times, happened) if yes), None)


def discs(statistics, kind, places, reached):
    """(time, place) of the discs that were reached."""
    found = []
    for place in places:
        column = statistics[f"water.{kind} {place:.2f}.particles"]
        time = first(statistics["time [s]"], reached(column))
        if time is not None:
            found.append((time, place))
    return zip(*found)


def draw(axes, curve, scale, shift, points, meshless):
    """One panel: bands and tables as in plot.json, marks, line."""
    for band in curve["bands"]:
        axes.fill_between(band["x"], band["low"], band["high"], color="0.55", alpha=0.25, linewidth=0,
                          label=band["label"])
    table = curve["reference"][0]
    axes.plot(table["x"], table["y"], "o", color="0.15", markerfacecolor="white", label=table["label"])
    times, places = points
    axes.plot([t * scale + shift["points"] for t in times], places, "s-", color="#d9541e", markersize=4,
              label="material points")
    times, places = meshless
    axes.plot([t * scale + shift["meshless"] for t in times], places, color="#0b62a4", label="meshless fluid")
    axes.set(xlabel=curve["x label"], ylabel=curve["y label"], xlim=curve["x limits"], ylim=curve["y limits"])
    axes.grid(color="0.9")
    axes.legend(frameon=False, fontsize=8)


def main():
    arguments = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    arguments.add_argument("points", type=pathlib.Path, help="output of column_collapse.prm")
    arguments.add_argument("meshless", type=pathlib.Path, help="output of column_collapse_meshless.prm")
    arguments.add_argument("-o", default="column_collapse.png", metavar="FILE")
    options = arguments.parse_args()
    front, height = json.loads((HERE / "plot.json").read_text())["curves"]
    points, meshless = Output(options.points).statistics, Output(options.meshless).statistics
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(9, 3.8), layout="constrained")
    draw(left, front, math.sqrt(2 * GRAVITY / WIDTH), SHIFT,
         discs(points, "front", front["reference"][0]["y"], lambda n: n > 0),
         (meshless["time [s]"], meshless["water.highest.x [m]"] / WIDTH))
    draw(right, height, math.sqrt(GRAVITY / WIDTH), {"points": 0, "meshless": 0},
         discs(points, "height", height["reference"][0]["y"], lambda n: n == 0),
         (meshless["time [s]"], meshless["water.highest.y [m]"] / WIDTH / 2))
    left.set_title("front", loc="left", fontsize=10)
    right.set_title("height at the wall", loc="left", fontsize=10)
    figure.savefig(options.o, dpi=90)


if __name__ == "__main__":
    main()
