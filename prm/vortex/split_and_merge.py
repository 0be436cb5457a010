#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What splitting and merging cost in accuracy: the vortex with and without two cycles of both (cycle.prm).

    prm/vortex/split_and_merge.py build/release/coracle [-o FOLDER]

Errors are root mean squares over the particles of the difference between their velocity and the exact one at
their place, over the largest speed of the exact motion. Needs python3-h5py.
"""
import argparse
import pathlib
import subprocess
import sys

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent.parent / "contrib"))
from read_output import Output  # noqa: E402

LARGEST_ANGLE = 0.02


def exact_velocity(points, time):
    """dR/dt = 0: the angle's rate is that of the circle that the place is on."""
    radius = np.hypot(points[:, 0], points[:, 1])
    rate = LARGEST_ANGLE * np.pi * np.cos(np.pi * time) * (1 - 16 * (radius - 1) ** 2) ** 2
    return np.stack((-points[:, 1] * rate, points[:, 0] * rate), 1)


def run(options, case, name, values):
    folder = options.output / name
    command = [options.executable, str(HERE / case), "--set", f"Output/Directory={folder}",
               "--set", "Output/Interval=0.05", "--set", "End time=0.3"]
    for value in values:
        command += ["--set", value]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode not in (0, 1):
        sys.exit(done.stdout)
    return Output(folder)


def main():
    arguments = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    arguments.add_argument("executable")
    arguments.add_argument("-o", "--output", type=pathlib.Path, default=pathlib.Path("output/vortex_cycle"))
    options = arguments.parse_args()
    fine = ["Grid/Cell size=0.03125", "Bodies/ring/Particle spacing=0.015625"]
    runs = {"coarse": ("vortex.prm", []), "fine": ("vortex.prm", fine), "cycles": ("cycle.prm", [])}
    scale = LARGEST_ANGLE * np.pi
    for name, (case, values) in runs.items():
        output = run(options, case, name, values)
        series = output.series["ring"]
        for index in range(1, len(series.times)):
            frame = series.read(index)
            points, velocity = frame.points[:, :2], frame.point_data["velocity"][:, :2]
            size = frame.point_data["size"].ravel()
            difference = np.linalg.norm(velocity - exact_velocity(points, frame.time), axis=1)
            mean = np.sqrt(np.average(difference**2, weights=size**2)) / scale
            momentum = np.sum(size**2 * (points[:, 0] * velocity[:, 1] - points[:, 1] * velocity[:, 0]))
            print(f"{name:<8} t = {frame.time:.3f} s: {len(points):>6} particles, error {100 * mean:.3f} %, "
                  f"angular momentum {momentum:.9e}", flush=True)


if __name__ == "__main__":
    main()
