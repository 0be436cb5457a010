#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A disk that is full at any byte of a checkpoint, on one rank and on two: it is named, the run goes on to
its end as if nothing had been, the checkpoints that are there are whole, and a run goes on from the newest.

The disk is a small file system in memory, which needs a user who may mount one (root, or anybody where
user name spaces are allowed); elsewhere this says so and tests nothing."""
import shlex
import subprocess

from run_case import Test

# Its octree has many leaves, so that it is a large part of the state.
CASE = "sliding/block.prm"
VALUES = {"End time": "10 ms", "Output/Statistics interval in steps": 1, "Checkpoint/Interval in steps": 5,
          "Grid/Cell size": "12.5 mm"}
PAGE = 4096
test = Test()


def mounted(directory, size, commands):
    """What commands say that have a disk of so many bytes in the place of the checkpoints."""
    place = directory / "checkpoints"
    place.mkdir(parents=True)
    script = f"mount -t tmpfs -o size={size} tmpfs {shlex.quote(str(place))} || exit 99\n" + "\n".join(commands)
    for options in (["-m"], ["-rm"]):
        done = subprocess.run(["unshare", *options, "sh", "-c", script], text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        if done.returncode == 0:
            return done.stdout
        if "Operation not permitted" not in done.stdout and done.returncode != 99:
            break
    print(done.stdout)
    return None


def say(command):
    return shlex.join(map(str, command)) + '; echo "exit code $?"'


if mounted(test.new_directory(CASE), PAGE, ["true"]) is None:
    print("skipped: this user may not mount a file system in memory")
    test.finish()

for ranks in (1, 2):
    whole = test.run(CASE, VALUES, ranks)
    newest = sorted((whole.directory / "checkpoints").glob("step_*"))[-1]
    sizes = [-(-path.stat().st_size // PAGE) * PAGE for path in newest.iterdir()]
    one = sum(sizes)
    # No checkpoint at all; one and part of the next; two and part of the next, down to its last file.
    for share in (0.02, 0.5, 0.99, 1.3, 1.7, 2.5, 3 - 2.5 * PAGE / one, 3.2):
        directory = test.new_directory(CASE)
        size = int(share * one) // PAGE * PAGE + PAGE
        copy = directory / "copy"
        text = mounted(directory, size, [
            say(test.command(CASE, directory, VALUES, ranks)),
            f"ls {shlex.quote(str(directory / 'checkpoints'))}",
            f"cp -r {shlex.quote(str(directory / 'checkpoints'))} {shlex.quote(str(copy))}"])
        name = f"{ranks} ranks, room for {share:.3f} checkpoints"
        statistics = (directory / "statistics.csv").read_bytes()
        test.check(f"{name}: the run ends as on a large disk",
                   text is not None and "exit code 0" in text
                   and statistics == (whole.directory / "statistics.csv").read_bytes())
        full = share < 3
        test.check(f"{name}: {'the full disk is named' if full else 'nothing is amiss'}",
                   ("a checkpoint could not be written" in text and "No space left on device" in text) == full)
        there = sorted(path.name for path in copy.iterdir())
        test.check(f"{name}: {len(there)} checkpoints are there, and nothing else",
                   len(there) == min(2, int(share)) and all(n[5:].isdigit() for n in there))
        # Go on from what is there, on a disk with room.
        (directory / "checkpoints").rmdir()
        copy.rename(directory / "checkpoints")
        again = test.run(CASE, VALUES, ranks, ["--restart"], 0 if there else 2, directory)
        if there:
            test.check(f"{name}: the newest is gone on from, and nothing else is changed",
                       f"going on from {directory / 'checkpoints' / there[-1]}" in again.text
                       and (directory / "statistics.csv").read_bytes() == statistics)
        else:
            test.check(f"{name}: never is a run begun anew in silence",
                       "no checkpoint to go on from" in again.text
                       and (directory / "statistics.csv").read_bytes() == statistics)
test.finish()
