# SPDX-License-Identifier: GPL-3.0-or-later
"""Curves of one or more runs over reference curves and bands, as told by plot.json."""
import csv

import numpy as np
from matplotlib.figure import Figure

from plot_expression import evaluate


def moving_mean(x, y, width):
    """Mean of y over a window of this width in x around each place, by the trapezoidal integral."""
    integral = np.concatenate(([0.0], np.cumsum(0.5 * (y[1:] + y[:-1]) * np.diff(x))))
    low = np.maximum(x - width / 2, x[0])
    high = np.minimum(x + width / 2, x[-1])
    length = np.maximum(high - low, 1e-300)
    mean = (np.interp(high, x, integral) - np.interp(low, x, integral)) / length
    return np.where(high > low, mean, y)


def table(entry, case):
    """Columns of a reference: lists in place, or 'table' (a CSV file in the case's folder)."""
    if "table" not in entry:
        return entry
    with open(case / entry["table"], newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    columns = {key: entry[key] for key in ("x", "y", "low", "high") if key in entry}
    return dict(entry, **{key: [float(row[name]) for row in rows] for key, name in columns.items()})


def draw_reference(axes, entry, case, number):
    colour = entry.get("colour", ("0.15", "0.45", "0.6")[number % 3])
    if "expression" in entry:
        x = np.linspace(*entry["from to"], 200)
        y = evaluate(entry["expression"], {}, {"x": x}) * np.ones_like(x)
    else:
        entry = table(entry, case)
        x, y = np.array(entry["x"], dtype=float), np.array(entry["y"], dtype=float)
    points = entry.get("style", "line") == "points"
    axes.plot(
        x * entry.get("x scale", 1),
        y * entry.get("y scale", 1),
        label=entry.get("label"),
        color=colour,
        linestyle="none" if points else ("--", ":", "-.")[number % 3],
        marker=("o", "s", "^")[number % 3] if points else None,
        markerfacecolor="white",
        linewidth=1.4,
        zorder=3 if points else 2,
    )


def draw_band(axes, entry, case):
    """Between two curves, or a box [x0, x1, y0, y1]."""
    colour = entry.get("colour", "0.55")
    if "box" in entry:
        x0, x1, low, high = entry["box"]
        x, y0, y1 = [x0, x1], [low, low], [high, high]
    else:
        entry = table(entry, case)
        scale = entry.get("y scale", 1)
        x = np.array(entry["x"], dtype=float) * entry.get("x scale", 1)
        y0, y1 = (np.array(entry[key], dtype=float) * scale for key in ("low", "high"))
    axes.fill_between(x, y0, y1, color=colour, alpha=0.25, linewidth=0, label=entry.get("label"))


def draw(curve, runs, case):
    figure = Figure(figsize=curve.get("size", (6.2, 3.9)))
    axes = figure.subplots()
    for band in curve.get("bands", []):
        draw_band(axes, band, case)
    for number, reference in enumerate(curve.get("reference", [])):
        draw_reference(axes, reference, case, number)
    for number, run in enumerate(runs):
        for line in curve["lines"]:
            if line.get("run", number) != number:
                continue
            x = evaluate(line.get("x", "{time [s]}"), run.statistics)
            y = evaluate(line["y"], run.statistics) * np.ones_like(x)
            if "mean over" in line:
                y = moving_mean(x, y, line["mean over"])
            label = line.get("label", "")
            if len(runs) > 1 and "run" not in line:
                label = f"{label}, {run.folder.name}".strip(", ")
            scale = (line.get("x scale", 1), line.get("y scale", 1))
            axes.plot(x * scale[0], y * scale[1], label=label, linewidth=line.get("width", 1.8), zorder=4)
    axes.set_xlabel(curve["x label"])
    axes.set_ylabel(curve["y label"])
    axes.set_title(curve.get("title", ""))
    if "x limits" in curve:
        axes.set_xlim(*curve["x limits"])
    if "y limits" in curve:
        axes.set_ylim(*curve["y limits"])
    axes.legend(fontsize=8.5)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    return figure
