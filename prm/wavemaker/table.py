#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Run the three wavemakers and compare the height of their waves with linear theory.

    prm/wavemaker/table.py [--program build/release/coracle] [--spacing METRES] [--drawn] [-o FOLDER]

Wave height: twice the amplitude of the piston's frequency in the gauge's record, over the whole
periods at its end; and beside it the mean from trough to crest. With --drawn no run, but a picture of the last ones. Needs python3-numpy, and
python3-matplotlib for the picture.
"""
import argparse
import csv
import math
import pathlib
import subprocess

import numpy

CASE = pathlib.Path(__file__).resolve().parent
#             k h, stroke [m], frequency [1/s], periods looked at
CASES = {"longer": (0.5, 0.040, 1.50556, 3), "wavemaker": (1.0, 0.020, 2.73335, 4),
         "shorter": (2.0, 0.012, 4.34902, 5)}


def theory(kh):
    """Of a piston: Dean & Dalrymple, Water Wave Mechanics for Engineers and Scientists, ch. 6."""
    return 2 * (math.cosh(2 * kh) - 1) / (math.sinh(2 * kh) + 2 * kh)


def read(folder):
    with open(folder / "statistics.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return {name: numpy.array([float(row[name]) for row in rows])
            for name in ("time [s]", "water.gauge.height [m]", "water.volume_drift")}


def heights(record, frequency, periods):
    """From the piston's frequency, and from trough to crest."""
    time, surface = record["time [s]"], record["water.gauge.height [m]"]
    last = time >= time[-1] - periods * 2 * math.pi / frequency
    time, surface = time[last], surface[last]
    parts = numpy.stack([numpy.ones_like(time), time, *(f(n * frequency * time) for n in (1, 2, 3)
                                                        for f in (numpy.cos, numpy.sin))], axis=1)
    found = numpy.linalg.lstsq(parts, surface, rcond=None)[0]
    period = 2 * math.pi / frequency
    whole = [surface[(time >= time[0] + i * period) & (time <= time[0] + (i + 1) * period)]
             for i in range(periods)]
    return 2 * math.hypot(found[2], found[3]), numpy.mean([w.max() - w.min() for w in whole])


def draw(records, file):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    figure, grid = pyplot.subplots(len(records), 1, figsize=(6.4, 6), sharex=True, layout="constrained")
    for axes, (case, record) in zip(grid, records.items()):
        kh, stroke, frequency, _ = CASES[case]
        size = stroke * theory(kh)
        for sign in (-1, 1):
            axes.axhspan(0.45 * sign, 0.55 * sign, color="0.85")
            axes.axhline(0.5 * sign, color="0.3", linestyle="--", linewidth=1)
        axes.plot(record["time [s]"] * frequency / (2 * math.pi),
                  (record["water.gauge.height [m]"] - 1) / size, color="#0b62a4")
        axes.set(ylabel="over theory's H", ylim=(-0.65, 0.65), xlim=(0, 12))
        axes.set_title(f"k h = {kh}: H = {theory(kh):.3f} S", loc="left", fontsize=10)
    grid[-1].set_xlabel("time over the period")
    figure.suptitle("Surface at four depths from the piston; dashed: linear theory, grey: ±10 %", fontsize=10)
    figure.savefig(file, dpi=90)


def main():
    arguments = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    arguments.add_argument("--program", default="build/release/coracle")
    arguments.add_argument("--spacing", help="of points [m], instead of the cases'")
    arguments.add_argument("--drawn", action="store_true", help="draw what an earlier run left")
    arguments.add_argument("-o", type=pathlib.Path, default=pathlib.Path("output"))
    options = arguments.parse_args()
    if options.drawn:
        draw({case: read(options.o / case) for case in CASES}, options.o / "waves.png")
        return
    print("| k h | H/S, theory | H/S | error | trough to crest | volume drift |\n|---|---|---|---|---|---|")
    for case, (kh, stroke, frequency, periods) in CASES.items():
        folder = options.o / case
        command = [options.program, str(CASE / f"{case}.prm"), "--set", f"Output/Directory={folder}"]
        if options.spacing:
            edges = round(0.3 / float(options.spacing)), round(1.3 / float(options.spacing))
            command += ["--set", f"Bodies/water/Spacing={options.spacing}",
                        "--set", f"Bodies/piston/Mesh/Subdivisions={edges[0]}, {edges[1]}"]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        record = read(folder)
        wave, crest = (height / stroke for height in heights(record, frequency, periods))
        print(f"| {kh} | {theory(kh):.3f} | {wave:.3f} | {100 * (wave / theory(kh) - 1):+.1f} % | {crest:.3f} "
              f"| {max(abs(record['water.volume_drift'])):.0e} |", flush=True)


if __name__ == "__main__":
    main()
