#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A run that is killed (SIGKILL) at a random instant, also while it writes a checkpoint, and continued
until it ends, has the statistics of one that nobody disturbed.

    kill.py [runs]     10 without a number; each is killed once or twice
"""
import os
import random
import re
import signal
import subprocess
import sys
import time

from run_case import Test

N_RUNS = int(sys.argv[1]) if len(sys.argv) > 1 else 10
CASE = "sliding/block.prm"
# A checkpoint after every second step: most of the time goes into writing them.
VALUES = {"End time": "30 ms", "Bodies/plate/Friction": 0.2, "Checkpoint/Interval in steps": 2, "Output/Interval in steps": 5,
          "Output/Statistics interval in steps": 1}

test = Test()
seed = int(os.environ.get("CORACLE_SEED", "1"))
random.seed(seed)


def start(directory, options):
    command = test.command(CASE, directory, VALUES, 1, options)
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def run_to_end(directory, n_kills, duration):
    """Returns what the last run said, and how many were killed while they wrote a checkpoint."""
    n_while_writing = 0
    for kill in range(n_kills + 1):
        there = list((directory / "checkpoints").glob("step_*"))
        whole = [path for path in there if re.fullmatch(r"step_\d+", path.name)]
        process = start(directory, ["--restart"] if whole else [])
        if kill < n_kills:
            time.sleep(random.uniform(0, duration))
            process.send_signal(signal.SIGKILL)
        text = process.communicate()[0]
        n_while_writing += any((directory / "checkpoints").glob("*.tmp"))
    return process.returncode, text, n_while_writing


begin = time.monotonic()
whole = test.run(CASE, VALUES, exit_code=None)
duration = time.monotonic() - begin
expected = (whole.directory / "statistics.csv").read_bytes()
print(f"seed {seed}; undisturbed: {len(whole['step'])} rows in {duration:.2f} s")

n_equal = n_while_writing = 0
for i in range(N_RUNS):
    directory = test.new_directory(CASE)
    code, text, n = run_to_end(directory, random.choice([1, 1, 2]), duration)
    n_while_writing += n
    equal = (directory / "statistics.csv").read_bytes() == expected and code == whole.exit_code
    n_equal += equal
    if not equal:
        print(f"{directory} is another; the last run ended with {code} and said:\n{text}")
test.check(f"{n_equal} of {N_RUNS} end as the undisturbed run", n_equal == N_RUNS)
print(f"killed while a checkpoint was written: {n_while_writing}")
test.finish()
