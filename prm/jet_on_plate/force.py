#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Normal force of the jet on the plate against rho Q U sin(alpha), and optionally a plot of F(t).

    prm/jet_on_plate/force.py 90=FOLDER [60=FOLDER ...] [-o FILE.png]

Each folder is a run's output, the number the angle between jet and plate. Means over 0.1 to 0.2 s.
"""
import argparse
import csv
import math
import pathlib

DENSITY, WIDTH, SPEED = 1000, 0.1, 5
WINDOW = 0.1, 0.2


def normal_force(folder, alpha):
    """Times, and force on the plate along its normal, from the water's side."""
    with open(pathlib.Path(folder) / "statistics.csv", newline="") as file:
        rows = list(csv.reader(file))
    column = {name: i for i, name in enumerate(rows[0])}
    turn = math.radians(90 - alpha)
    time = [float(row[column["time [s]"]]) for row in rows[1:]]
    force = [math.sin(turn) * float(row[column["plate.contact_force.x [N]"]])
             - math.cos(turn) * float(row[column["plate.contact_force.y [N]"]]) for row in rows[1:]]
    return time, force


def exact(alpha):
    return DENSITY * WIDTH * SPEED * SPEED * math.sin(math.radians(alpha))


def mean(time, force):
    inside = [f for t, f in zip(time, force) if WINDOW[0] < t <= WINDOW[1]]
    return sum(inside) / len(inside)


def plot(runs, file):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(6.4, 3.6))
    for alpha, (time, force) in sorted(runs.items(), reverse=True):
        # Means over 4 ms: single milliseconds show the waves that run across the jet.
        smooth = [sum(force[max(0, i - 1):i + 3]) / len(force[max(0, i - 1):i + 3])
                  for i in range(len(force))]
        line, = axes.plot([1000 * t for t in time], smooth, linewidth=1, label=f"{alpha:g} degrees")
        axes.axhline(exact(alpha), color=line.get_color(), linestyle="--", linewidth=0.8)
    axes.set(xlabel="time [ms]", ylabel="normal force [N per m]", xlim=(0, 200), ylim=(0, 4000))
    axes.set_title("Jet on a plate; dashed: rho Q U sin(alpha)", fontsize=10, loc="left")
    axes.legend(frameon=False)
    figure.tight_layout()
    figure.savefig(file, dpi=100)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("runs", nargs="+", metavar="ALPHA=FOLDER")
    parser.add_argument("-o", "--output")
    arguments = parser.parse_args()
    runs = {}
    for run in arguments.runs:
        alpha, folder = run.split("=", 1)
        runs[float(alpha)] = normal_force(folder, float(alpha))
    for alpha, (time, force) in runs.items():
        value = mean(time, force)
        print(f"{alpha:g} degrees: {value:.1f} N/m, exact {exact(alpha):.1f} N/m, "
              f"{100 * (value / exact(alpha) - 1):+.2f} %")
    if arguments.output:
        plot(runs, arguments.output)


if __name__ == "__main__":
    main()
