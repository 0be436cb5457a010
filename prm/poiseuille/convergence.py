#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Orders of accuracy of the driven channel: error of the points' velocities at the end.

    prm/poiseuille/convergence.py build/release/coracle [-l 4] [-o FOLDER] [--set Section/Key=value ...]

Spacing: each level halves spacing and steps, the start along rows. Steps: one spacing, each level
halves the steps; the error is the change of the velocity from level to level, row by row, as that of
the spacing is the same in all. Needs python3-h5py.
"""
import argparse
import math
import pathlib
import subprocess
import sys

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent.parent / "contrib"))
from read_output import Output  # noqa: E402


def exact(y, time):
    return 2.5 * y * (1 - y) - 0.4 * np.sin(np.pi * y) * math.exp(-0.2 * np.pi**2 * time)


def run(options, name, spacing, step, *more):
    """Places and velocities of the points at the end, and the time."""
    folder = options.output / name
    command = [options.executable, str(HERE / "poiseuille.prm")]
    for value in [f"Output/Directory={folder}", f"Bodies/oil/Spacing={spacing}",
                  f"Time/Largest step={step}", *more, *options.set]:
        command += ["--set", value]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode not in (0, 1):
        sys.exit(done.stdout)
    series = Output(folder).series["oil"]
    frame = series.read(len(series.times) - 1)
    return frame.points[:, 1], frame.point_data["velocity"][:, :2], frame.time


def error(points, velocity, time):
    """Root mean square over that of the exact velocity."""
    right = exact(points, time)
    square = (velocity[:, 0] - right) ** 2 + velocity[:, 1] ** 2
    return math.sqrt(np.mean(square) / np.mean(right**2))


def order(before, now):
    return f"{math.log2(before / now):.2f}" if before else "-"


def main():
    arguments = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    arguments.add_argument("executable")
    arguments.add_argument("-l", "--levels", type=int, default=4)
    arguments.add_argument("-o", "--output", type=pathlib.Path, default=pathlib.Path("output/poiseuille"))
    arguments.add_argument("--set", action="append", default=[], metavar="Section/Key=value")
    options = arguments.parse_args()

    before = None
    for level in range(options.levels):
        n = 10 * 2**level
        now = error(*run(options, f"spacing.{level}", 1 / n, 1 / n))
        print(f"spacing 1/{n}, steps 1/{n} s: error {now:.3e} (order in both {order(before, now)})", flush=True)
        before = now
    rows, before = None, None
    for level in range(options.levels + 1):
        n = 12 * 2**level
        y, velocity, _ = run(options, f"steps.{level}", 0.05, 1 / n, "Bodies/oil/Largest move=1")
        means = np.array([velocity[np.abs(y - row / 20) < 0.01, 0].mean() for row in range(21)])
        if rows is not None:
            now = float(np.abs(means - rows).max())
            print(f"steps 1/{n} s: change {now:.3e} m/s (order in steps {order(before, now)})", flush=True)
            before = now
        rows = means


if __name__ == "__main__":
    main()
