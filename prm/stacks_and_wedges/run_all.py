#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Run all scenes of this folder and print one table; exit code 1 if a particle passed anywhere.

    run_all.py [-e build/release/coracle] [-o directory] [scene ...]
"""
import argparse
import csv
import pathlib
import re
import subprocess
import sys
import time


def run(executable, case, directory):
    """Last row of the statistics, verdict and seconds of one scene."""
    start = time.time()
    done = subprocess.run([executable, case, "--set", f"Output/Directory={directory}"],
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    rows = []
    path = directory / "statistics.csv"
    if path.exists():
        with open(path, newline="") as file:
            rows = [{k.strip(): v for k, v in row.items()} for row in csv.DictReader(file)]
    verdict = re.search(r"verdict: (.*)", done.stdout)
    text = verdict.group(1).strip() if verdict else done.stdout.strip().splitlines()[0]
    return rows[-1] if rows else {}, text, time.time() - start


def find(row, *names):
    for name in names:
        for key in row:
            if key.split(" [")[0] == name:
                return float(row[key])
    return float("nan")


def main():
    here = pathlib.Path(__file__).resolve().parent
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-e", "--executable", default=here.parents[1] / "build/release/coracle")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=pathlib.Path("stacks_and_wedges"))
    parser.add_argument("scenes", nargs="*")
    options = parser.parse_args()
    scenes = options.scenes or sorted(p.stem for p in here.glob("*.prm")
                                      if p.stem not in ("plane", "space"))
    print("| scene | particles | steps | contact steps | not converged | ends changed | penetrations "
          "| balance | verdict | s |\n|---|---|---|---|---|---|---|---|---|---|")
    passed = 0
    for scene in scenes:
        row, verdict, seconds = run(options.executable, here / f"{scene}.prm", options.output / scene)
        n = find(row, "penetrations")
        passed += not n == 0
        print(f"| `{scene}` | {find(row, 'particles'):.0f} | {find(row, 'step'):.0f} "
              f"| {find(row, 'contact_steps'):.0f} | {find(row, 'unconverged_contact_steps'):.0f} "
              f"| {find(row, 'contact.resolved_in_time'):.0f} | {n:.0f} "
              f"| {100 * find(row, 'energy.balance_error', 'energy_balance_error'):.2f} % "
              f"| {verdict.split()[0]} | {seconds:.1f} |", flush=True)
    print(f"\n{len(scenes)} scenes, {passed} with penetrations or broken off")
    sys.exit(1 if passed else 0)


main()
