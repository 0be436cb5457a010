# SPDX-License-Identifier: GPL-3.0-or-later
"""Open every .xdmf and .pvd of a folder by other people's libraries and print what they saw.

Sums weighted by the place of a value in its array tell whether values and their order are right.
"""
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "contrib"))
from read_output import VtuSeries, XdmfSeries  # noqa: E402


def weighted_sum(values):
    flat = np.asarray(values, dtype=float).reshape(-1)
    return float(np.dot(np.arange(1, len(flat) + 1), flat))


def show(label, data):
    for name in sorted(data):
        values = data[name]
        n_components = 1 if values.ndim == 1 else values.shape[1]
        print(f"    {label} {name} {n_components} {weighted_sum(values):.8g}")


folder = pathlib.Path(sys.argv[1])
for file in sorted(folder.glob("*.xdmf")) + sorted(folder.glob("*.pvd")):
    series = XdmfSeries(file) if file.suffix == ".xdmf" else VtuSeries(file)
    for index, time in enumerate(series.times):
        frame = series.read(index)
        print(f"  {file.name} time {time:.6g} points {len(frame.points)} cells {len(frame.cells)}")
        if len(frame.points):
            print(f"    points {weighted_sum(frame.points):.8g}")
            print(f"    corners {weighted_sum(frame.points[frame.cells]):.8g}")
            show("point", frame.point_data)
            show("cell", frame.cell_data)
