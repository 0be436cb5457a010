#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Run the eight cases, with the sphere as given and ten times stiffer, with both contacts, and print
the table of README.md. Finished runs are not repeated: a line of the table needs its folder only.

    prm/rolling_sphere/run_all.py [build/release/coracle] [folder of the results] [rows to run ...]
"""
import csv
import pathlib
import subprocess
import sys

here = pathlib.Path(__file__).resolve().parent
program = sys.argv[1] if len(sys.argv) > 1 else "build/release/coracle"
results = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else "output/rolling_sphere_table")
wanted = sys.argv[3:]

# Elements 0.2, 0.4, 0.8 and 1.6 m; the last do not divide 20 m evenly and are 1.67 m long.
MESHES = {1: "100, 32, 8", 2: "50, 16, 4", 4: "25, 8, 2", 8: "12, 4, 1"}
EXACT = {0.2: (11.314, 4.419), 0.4: (10.102, 6.313)}
KINDS = {
    "given": [],
    "stiff": ["Materials/soft/Young modulus=4.2e7"],
    "grid": ["Contact/Method=grid"],
    "stiff_grid": ["Materials/soft/Young modulus=4.2e7", "Contact/Method=grid"],
}


def settings(friction, ratio, kind):
    return [
        f"Bodies/plate/Friction={friction}",
        f"Bodies/plate/Mesh/Subdivisions={MESHES[ratio]}",
        "Output/Particle format=none",
        "Output/Structures=false",
    ] + KINDS[kind]


def last_row(folder):
    with open(folder / "statistics.csv") as file:
        return list(csv.DictReader(file))[-1]


print("| case | contact, sphere | mu | elements / cell | x(2 s) [m] | off | spin [rad/s] | off | penetrations |")
print("|---|---|---|---|---|---|---|---|---|")
for kind in KINDS:
    for case in range(1, 9):
        friction, ratio = (0.2 if case < 5 else 0.4), 2 ** ((case - 1) % 4)
        name = f"{kind}_{case}"
        folder = results / name
        if wanted and name not in wanted:
            continue
        if not (folder / "statistics.csv").exists():
            command = [program, str(here / "rolling_sphere.prm"), "--set", f"Output/Directory={folder}"]
            for setting in settings(friction, ratio, kind):
                command += ["--set", setting]
            # A run that ends SUSPECT still has its row.
            subprocess.run(command, stdout=subprocess.DEVNULL)
        row = last_row(folder)
        x, spin = float(row["sphere.centre.x [m]"]), float(row["sphere.angular_velocity.y [rad/s]"])
        exact_x, exact_spin = EXACT[friction]
        print(
            f"| {case} | {kind} | {friction} | {ratio} | {x:.3f} | {100 * (x / exact_x - 1):+.2f} % "
            f"| {spin:.3f} | {100 * (spin / exact_spin - 1):+.2f} % | {row['penetrations']} |",
            flush=True,
        )
