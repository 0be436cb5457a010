#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Water on the folded plate in two or more runs side by side, as Song, Liu & Zhang's (2020) figure 16;
particles below the plate are red.

    prm/folded_plate/picture.py FILE.png TIME "TITLE=OUTPUT FOLDER" ["TITLE=OUTPUT FOLDER" ...]

Needs python3-matplotlib, python3-h5py and python3-vtk9.
"""
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

from sweep import Output, plate_height  # noqa: E402


def main():
    file, time, *runs = sys.argv[1:]
    figure, axes = plt.subplots(1, len(runs), figsize=(4.6 * len(runs), 3.5), squeeze=False,
                                sharey=True)
    for panel, run in zip(axes[0], runs):
        title, folder = run.rsplit("=", 1)
        frame = Output(folder).read("water", float(time))
        speed = np.linalg.norm(frame.point_data["velocity"], axis=1)
        dots = panel.scatter(frame.points[:, 0], frame.points[:, 1], s=3.5, c=speed, cmap="viridis",
                             linewidths=0, vmin=0, vmax=np.percentile(speed, 99))
        through = frame.points[frame.points[:, 1] < plate_height(frame.points[:, 0])]
        panel.scatter(through[:, 0], through[:, 1], s=14, c="red", linewidths=0)
        x = np.arange(-0.05, 0.86, 0.05)
        panel.plot(x, 0.2 - 0.05 * (np.arange(len(x)) % 2 == 0), color="black", linewidth=1.2)
        panel.set(xlim=(0.1, 0.7), ylim=(0.1, 0.5), aspect="equal", xlabel="x [m]")
        panel.set_title(f"{title}, t = {1000 * frame.time:.3g} ms", fontsize=9, loc="left")
        figure.colorbar(dots, ax=panel, shrink=0.7, label="speed [m/s]")
    axes[0][0].set_ylabel("y [m]")
    figure.tight_layout()
    figure.savefig(file, dpi=80)


if __name__ == "__main__":
    main()
