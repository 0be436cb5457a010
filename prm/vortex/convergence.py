#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Order of accuracy of the generalised vortex: error of the particles' positions on finer and finer grids.

    prm/vortex/convergence.py build/release/coracle [-c smooth] [-l 4] [-o FOLDER] [--set Section/Key=value ...]

Each level halves the cells and the steps. The error is the root mean square over all particles,
weighted alike, of the distance from where the exact motion has brought them. Needs python3-h5py.
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

LARGEST_ANGLE = 0.02
POWER = {"vortex": 2, "smooth": 4}


def exact(points, time, power):
    """Where the motion has brought points that were there at time 0."""
    radius = np.hypot(points[:, 0], points[:, 1])
    angle = LARGEST_ANGLE * np.sin(np.pi * time) * (1 - 16 * (radius - 1) ** 2) ** power
    x, y = points[:, 0], points[:, 1]
    return np.stack((x * np.cos(angle) - y * np.sin(angle), x * np.sin(angle) + y * np.cos(angle)), 1)


def positions(series, index):
    """Positions in the order of the particles' ids, and the time."""
    frame = series.read(index)
    return frame.points[np.argsort(frame.point_data["id"]), :2], frame.time


def errors(folder, power):
    """(time, root mean square, largest) for each output but the first."""
    series = Output(folder).series["ring"]
    start, _ = positions(series, 0)
    result = []
    for index in range(1, len(series.times)):
        now, time = positions(series, index)
        distance = np.linalg.norm(now - exact(start, time, power), axis=1)
        result.append((time, math.sqrt(np.mean(distance**2)), distance.max()))
    return result


def run(options, level):
    size = 0.125 / 2**level
    folder = options.output / f"level.{level}"
    values = [f"Output/Directory={folder}", f"Grid/Cell size={size}",
              f"Bodies/ring/Particle spacing={size / 2}", *options.set]
    command = [options.executable, str(HERE / f"{options.case}.prm")]
    for value in values:
        command += ["--set", value]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode not in (0, 1):
        sys.exit(done.stdout)
    return size, errors(folder, POWER[options.case]), done.returncode


def main():
    arguments = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    arguments.add_argument("executable")
    arguments.add_argument("-c", "--case", choices=POWER, default="vortex")
    arguments.add_argument("-l", "--levels", type=int, default=4)
    arguments.add_argument("-o", "--output", type=pathlib.Path, default=pathlib.Path("output/vortex"))
    arguments.add_argument("--set", action="append", default=[], metavar="Section/Key=value")
    options = arguments.parse_args()

    before = None
    for level in range(options.levels):
        size, found, code = run(options, level)
        for i, (time, mean, largest) in enumerate(found):
            order = math.log2(before[i][1] / mean) if before else float("nan")
            order_of_largest = math.log2(before[i][2] / largest) if before else float("nan")
            print(f"h = 1/{1 / size:<5.4g} t = {time:.2f} s: mean error {mean:.4e} m (order {order:5.2f}), "
                  f"largest {largest:.4e} m (order {order_of_largest:5.2f}){'' if code == 0 else '  SUSPECT'}",
                  flush=True)
        before = found


if __name__ == "__main__":
    main()
