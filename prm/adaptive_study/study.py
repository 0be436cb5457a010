#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Run a case over levels of resolution, and tell error against cost.

    prm/adaptive_study/study.py build/release/coracle prm/adaptive_study/water_entry.json [-o FOLDER] [--ranks N]
                                [--only NAME ...] [--set Section/Key=value ...]

A study is a JSON file: `runs`, each with a `name`, a `series` that it belongs to in the plot, a `prm` (relative to the
file) and what it sets (`set`); the `reference` run that errors are taken against; and `quantities`. A quantity
is a `column` of the statistics between the times `from` and `to` [s], and a `kind`:

    rms      root mean square of the difference, over the largest of the reference
    largest  difference of the largest values, over that of the reference
    time of  difference of the times at which `value` is first passed, over that of the reference

`mean over` [s] takes running means first, `scale` multiplies the column. Cost is the number of particle-steps to the
time `until` of the study. Runs that are there already are not repeated. Needs python3-matplotlib for the plot.
"""
import argparse
import csv
import json
import pathlib
import subprocess
import sys


class Run:
    """Statistics of a run, as columns."""

    def __init__(self, folder):
        with open(folder / "statistics.csv", newline="") as file:
            rows = list(csv.reader(file))
        self.columns = {name.strip(): [float(row[i]) for row in rows[1:]] for i, name in enumerate(rows[0])}
        self.times = self.columns["time [s]"]

    def at(self, time, values):
        """Linear between rows."""
        low, high = 0, len(self.times) - 1
        if time >= self.times[high]:
            return values[high]
        while high - low > 1:
            middle = (low + high) // 2
            low, high = (middle, high) if self.times[middle] <= time else (low, middle)
        share = (time - self.times[low]) / (self.times[high] - self.times[low])
        return values[low] + share * (values[high] - values[low])


def samples(run, quantity, n=400):
    """The quantity at even times."""
    values = [quantity.get("scale", 1) * v for v in run.columns[quantity["column"]]]
    begin, end, width = quantity["from"], quantity["to"], quantity.get("mean over", 0)
    # Rows hold means since the row before: integrate first.
    if width > 0:
        sums = [0.0]
        for t0, t1, v in zip(run.times, run.times[1:], values[1:]):
            sums.append(sums[-1] + (t1 - t0) * v)
    times = [begin + (end - begin) * i / n for i in range(n + 1)]
    if width > 0:
        return times, [(run.at(t + width / 2, sums) - run.at(t - width / 2, sums)) / width for t in times]
    return times, [run.at(t, values) for t in times]


def number(run, quantity):
    times, values = samples(run, quantity)
    if quantity["kind"] == "largest":
        return max(values)
    return next((t for t, v in zip(times, values) if v >= quantity["value"]), float("nan"))


def error(run, reference, quantity):
    if quantity["kind"] == "rms":
        mine, other = samples(run, quantity)[1], samples(reference, quantity)[1]
        square = sum((a - b) ** 2 for a, b in zip(mine, other)) / len(mine)
        return square**0.5 / max(abs(v) for v in other)
    wanted = number(reference, quantity)
    return abs(number(run, quantity) - wanted) / abs(wanted)


def execute(options, description, study, folder):
    values = {"Output/Directory": folder, "Output/Particle format": "none", "Output/Structures": "false"}
    values.update(study.get("set", {}))
    values.update(description.get("set", {}))
    command = [options.executable, str(options.study.parent / description["prm"])]
    if options.ranks > 1:
        command = ["mpirun", "-q", "--oversubscribe", "-n", str(options.ranks), *command]
    for name, value in values.items():
        command += ["--set", f"{name}={value}"]
    for value in options.set:
        command += ["--set", value]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode not in (0, 1):
        sys.exit(done.stdout)
    (folder / "verdict.txt").write_text(done.stdout)


def plot(table, study, file):
    try:
        import matplotlib
    except ImportError:
        print("no plot: python3-matplotlib is not there")
        return
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    quantities = study["quantities"]
    figure, axes = plt.subplots(1, len(quantities), figsize=(4.2 * len(quantities), 3.6), squeeze=False)
    for axis, quantity in zip(axes[0], quantities):
        for series in dict.fromkeys(row["series"] for row in table):
            points = [(row["cost"], row[quantity["name"]], row["name"]) for row in table
                      if row["series"] == series and row["name"] != study["reference"]]
            if not points:
                continue
            axis.loglog([p[0] for p in points], [100 * p[1] for p in points],
                        "o-" if series == "uniform" else "s", label=series)
            for cost, value, name in points:
                axis.annotate(name, (cost, 100 * value), fontsize=7, xytext=(4, 4), textcoords="offset points")
        axis.set_xlabel("particle-steps")
        axis.set_ylabel("error [%]")
        axis.set_title(quantity["name"], fontsize=10)
        axis.grid(True, color="0.9")
        axis.legend(frameon=False)
    figure.suptitle(study["title"], fontsize=11)
    figure.tight_layout()
    figure.savefig(file, dpi=80)
    print(file)


def main():
    arguments = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    arguments.add_argument("executable")
    arguments.add_argument("study", type=pathlib.Path)
    arguments.add_argument("-o", "--output", type=pathlib.Path)
    arguments.add_argument("--ranks", type=int, default=1)
    arguments.add_argument("--only", nargs="+", metavar="NAME", help="besides the reference")
    arguments.add_argument("--set", action="append", default=[], metavar="Section/Key=value")
    options = arguments.parse_args()
    study = json.loads(options.study.read_text())
    output = options.output or pathlib.Path("output/adaptive_study") / options.study.stem

    runs = {}
    for description in study["runs"]:
        name = description["name"]
        if options.only and name not in options.only and name != study["reference"]:
            continue
        folder = output / name.replace(" ", "_")
        if not (folder / "verdict.txt").exists():
            print(f"runs: {name}", flush=True)
            execute(options, description, study, folder)
        runs[name] = Run(folder)

    reference, table = runs[study["reference"]], []
    for description in study["runs"]:
        if (name := description["name"]) not in runs:
            continue
        run = runs[name]
        row = {"name": name, "series": description["series"],
               "cost": run.at(study["until"], run.columns["particle_steps"]),
               "penetrations": int(max(run.columns["penetrations"]))}
        for quantity in study["quantities"]:
            row[quantity["name"]] = error(run, reference, quantity)
        table.append(row)
    names = [quantity["name"] for quantity in study["quantities"]]
    print(f"{'run':<28} {'particle-steps':>14} {'penetrations':>12} " + " ".join(f"{n:>22}" for n in names))
    for row in table:
        print(f"{row['name']:<28} {row['cost']:>14.3e} {row['penetrations']:>12d} "
              + " ".join(f"{100 * row[n]:>20.2f} %" for n in names))
    with open(output / "table.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, list(table[0]))
        writer.writeheader()
        writer.writerows(table)
    plot(table, study, output / "error_against_cost.png")


if __name__ == "__main__":
    main()
