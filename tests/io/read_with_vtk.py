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


# Faces of a hexahedron in VTK's order of corners, outward.
FACES = [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]


def measure(corners):
    """Area of quadrilaterals, volume of hexahedra with plane faces: right only in VTK's order."""
    if corners.shape[1] == 4:
        x, y = corners[:, :, 0], corners[:, :, 1]
        return 0.5 * np.sum(x * np.roll(y, -1, axis=1) - y * np.roll(x, -1, axis=1))
    volume = 0.0
    for a, b, c, d in FACES:
        for triangle in ((a, b, c), (a, c, d)):
            p, q, r = (corners[:, corner] for corner in triangle)
            volume += np.sum(p * np.cross(q, r)) / 6
    return volume


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
            if frame.cells.shape[1] >= 4:
                print(f"    measure {measure(frame.points[frame.cells]):.8g}")
            show("point", frame.point_data)
            show("cell", frame.cell_data)
