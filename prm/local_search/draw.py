#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw which points touch one and two facets, after Song, Liu & Zhang (2020), Figs. 11 and 12.

    prm/local_search/draw.py FOLDER [-o PICTURE]      FOLDER: what local_search_contacts has written

Points that touch inside a facet are filled, those that touch at an edge or corner hollow. Only every
so-many-th is drawn, and only one side of the facets, so that these stay visible.
"""
import argparse
import csv
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

METHODS = ["perpendicular foot", "nearest on surface"]
SCENES = [("one_facet", "one facet"), ("two_facets", "two facets that share an edge")]
N_DRAWN = 1000


def read(path):
    with open(path) as file:
        rows = list(csv.reader(file))
    return {name: np.array([float(row[i]) for row in rows[1:]]) for i, name in enumerate(rows[0])}


def surface(corners, n=13):
    """The bilinear facet as arrays for plot_surface."""
    s, t = np.meshgrid(np.linspace(0, 1, n), np.linspace(0, 1, n))
    weights = [(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t]
    return [sum(w * c[d] for w, c in zip(weights, corners)) for d in range(3)]


def draw(axes, folder, scene, title, method):
    facets, points = read(folder / f"{scene}_facets.csv"), read(folder / f"{scene}_points.csv")
    x = np.array([points[f"{name} [m]"] for name in "xyz"])
    corners = np.array([facets[f"{name} [m]"] for name in "xyz"]).T.reshape(-1, 4, 3)
    for facet in corners:
        axes.plot_surface(*surface(facet), color="#d9541e", alpha=0.55, linewidth=0)
        closed = np.vstack([facet, facet[:1]])
        axes.plot(*closed.T, color="#7a2c0c", linewidth=1.2)
    step = max(1, x.shape[1] // N_DRAWN)
    thinned = np.zeros(x.shape[1], bool)
    thinned[::step] = True
    for status, style in [
        (1, dict(color="#0b62a4", s=9, alpha=0.8, linewidths=0)),
        (2, dict(facecolors="none", edgecolors="0.35", s=11, linewidths=0.5)),
    ]:
        chosen = thinned & (points[method] == status)
        axes.scatter(*x[:, chosen], **style)
    n = [int(np.sum(points[method] == status)) for status in (1, 2)]
    axes.set_title(f"{title}: {method}\n{n[0]} inside, {n[1]} at edges", fontsize=9)
    axes.set(xlim=(-1, 1), ylim=(-1, 1), zlim=(-1, 1))
    axes.set_box_aspect((1, 1, 1), zoom=1.05)
    axes.view_init(elev=18, azim=-70)
    for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
        axis.set_ticks([-1, 0, 1])
    axes.tick_params(labelsize=7, pad=-2)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("-o", "--output", default="local_search.png")
    arguments = parser.parse_args()
    figure = plt.figure(figsize=(9, 8.4), dpi=76)
    for i, (scene, title) in enumerate(SCENES):
        for j, method in enumerate(METHODS):
            axes = figure.add_subplot(2, 2, 2 * i + j + 1, projection="3d")
            draw(axes, arguments.folder, scene, title, method)
    figure.tight_layout()
    figure.savefig(arguments.output, pil_kwargs={"optimize": True})


if __name__ == "__main__":
    main()
