# SPDX-License-Identifier: GPL-3.0-or-later
"""Run cases and judge their statistics; for the tests of this folder.

    from run_case import Test

    test = Test()
    result = test.run("water_entry/water_entry.prm", {"End time": "2 ms"}, ranks=2)
    test.check("no particle passes", max(result["penetrations"]) == 0)
    test.band("velocity at 1 ms", result.at(1e-3, "wedge.velocity.y [m/s]"), -6.2, -6.0)
    test.finish()

A test runs in a folder of its own; each run writes into <name of the case>.<number>.
"""
import bisect
import csv
import os
import pathlib
import shutil
import subprocess
import sys


class Result:
    """Columns of statistics.csv as lists of numbers: result["time [s]"]."""

    def __init__(self, directory, exit_code, text):
        self.directory, self.exit_code, self.text = directory, exit_code, text
        self.columns = {}
        path = directory / "statistics.csv"
        if path.exists():
            with open(path, newline="") as file:
                rows = list(csv.reader(file))
            for i, name in enumerate(rows[0]):
                self.columns[name.strip()] = [float(row[i]) for row in rows[1:]]

    def __getitem__(self, name):
        if name not in self.columns:
            sys.exit(f"there is no column '{name}'; there are: {', '.join(self.columns)}")
        return self.columns[name]

    def at(self, time, name):
        """Value at a time, linear between rows."""
        times, values = self["time [s]"], self[name]
        i = min(max(bisect.bisect(times, time), 1), len(times) - 1)
        share = (time - times[i - 1]) / (times[i] - times[i - 1])
        return values[i - 1] + share * (values[i] - values[i - 1])


class Test:
    def __init__(self):
        self.n_runs = 0
        self.failures = 0

    def new_directory(self, case):
        """A folder that no run has written to."""
        self.n_runs += 1
        directory = pathlib.Path.cwd() / f"{pathlib.Path(case).stem}.{self.n_runs}"
        shutil.rmtree(directory, ignore_errors=True)
        return directory

    @staticmethod
    def command(case, directory, values=None, ranks=1, options=()):
        """How to run prm/<case> (or a case with an absolute path) into a folder."""
        command = [os.environ["CORACLE"]]
        if ranks > 1:
            command = [*os.environ["CORACLE_MPIEXEC"].split(), str(ranks), *command]
        command += [str(pathlib.Path(os.environ["CORACLE_TOP"]) / "prm" / case), *options]
        for name, value in {"Output/Directory": directory, **(values or {})}.items():
            command += ["--set", f"{name}={value}"]
        return command

    def run(self, case, values=None, ranks=1, options=(), exit_code=0, directory=None, **process):
        """Run prm/<case> with some entries set; fails where the exit code is another (None: any)."""
        directory = directory or self.new_directory(case)
        command = self.command(case, directory, values, ranks, options)
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                              **process)
        what = f"{case} {' '.join(options)} on {ranks} ranks ends with {exit_code}"
        if not self.check(what, exit_code in (None, done.returncode)):
            print(f"it ended with {done.returncode} and said:\n{done.stdout}")
        return Result(directory, done.returncode, done.stdout)

    def check(self, what, right):
        print(("right:  " if right else "WRONG:  ") + what, flush=True)
        self.failures += not right
        return right

    def band(self, what, value, least, most):
        return self.check(f"{what}: {value:.6g} in [{least}, {most}]", least <= value <= most)

    def agree(self, what, first, second, tolerance):
        """Relative to the larger of the two."""
        difference = abs(first - second) / max(abs(first), abs(second), 1e-300)
        return self.check(f"{what}: {first:.9g} and {second:.9g} differ by {difference:.2g}, "
                          f"at most {tolerance}", difference <= tolerance)

    def finish(self):
        sys.exit(1 if self.failures else 0)
