#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checkpoints are written when they are asked for, by signals too; damaged ones, a full disk and a
changed case are named, and the next older good one is taken; never is a run begun anew in silence."""
import resource
import shutil
import signal
import subprocess
import time

from run_case import Test

CASE = "sliding/block.prm"
SHORT = {"End time": "10 ms", "Output/Statistics interval in steps": 1}
WRITES = {**SHORT, "Checkpoint/Interval in steps": 10}
test = Test()


def names(directory):
    return sorted(path.name for path in (directory / "checkpoints").glob("*"))


def statistics(directory):
    return (directory / "statistics.csv").read_bytes()


def signalled(signals, ranks=1):
    """A long run that gets signals: the first when it has told of a few steps, others 0.2 s later."""
    directory = test.new_directory(CASE)
    command = test.command(CASE, directory, {"Output/Log interval in steps": 1}, ranks)
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    log = directory / "log.txt"
    while not log.exists() or log.read_text().partition("particle-steps/s")[2].count("\n") < 5:
        time.sleep(0.02)
        if process.poll() is not None:
            break
    for number in signals:
        process.send_signal(number)
        time.sleep(0.2)
    text, _ = process.communicate(timeout=60)
    return process.returncode, directory, text


def files_of_newest(directory):
    return sorted((directory / "checkpoints" / names(directory)[-1]).glob("*"))


# Intervals, the number kept, and the end.
whole = test.run(CASE, WRITES)
test.check(f"two are kept, the last of the end: {names(whole.directory)}",
           names(whole.directory) == ["step_0000000030", "step_0000000040"])
timed = test.run(CASE, {**SHORT, "Checkpoint/Interval": "3 ms", "Checkpoint/Number kept": 9})
test.check(f"by simulated time: {names(timed.directory)}",
           names(timed.directory) == [f"step_00000000{n}" for n in (12, 24, 36, 40)])
clock = test.run(CASE, {**SHORT, "Checkpoint/Interval in wall time": "1e-9 s",
                        "Checkpoint/Number kept": 99})
test.check("by the clock: after every step", len(names(clock.directory)) == 40)
test.check("checkpoints change nothing",
           statistics(whole.directory) == statistics(clock.directory)
           == statistics(test.run(CASE, SHORT).directory))

# A longer run is the continuation of a shorter one, but for the last steps before its end.
longer = test.run(CASE, {**WRITES, "End time": "12 ms"}, 1, ["--restart"], 0, whole.directory)
test.check("a later end time is said", "End time: was '10 ms', is '12 ms'" in longer.text)
test.check("rows go on without a gap or a repetition", longer["step"] == list(range(len(longer["step"]))))

# Signals, the stop file, the limit of wall time.
for number in (signal.SIGINT, signal.SIGTERM):
    code, directory, text = signalled([number])
    test.check(f"{number.name} saves and says how to go on",
               code in (0, 1) and len(names(directory)) == 1 and f"stopped by {number.name}" in text
               and "--restart" in text)
code, directory, text = signalled([signal.SIGUSR1, signal.SIGUSR1, signal.SIGTERM])
test.check(f"SIGUSR1 saves and the run goes on: {names(directory)}", len(names(directory)) == 2)
end = test.run(CASE, {"End time": "20 ms", "Checkpoint/Wall time limit": "0.001 s"})
test.check("it stops before the limit of wall time",
           "stopped by Checkpoint/Wall time limit" in end.text and len(names(end.directory)) == 1)
whole20 = test.run(CASE, {"End time": "20 ms"})
back = test.run(CASE, {"End time": "20 ms"}, 1, ["--restart"], 0, end.directory)
test.check("and goes on as if it had not", statistics(whole20.directory) == statistics(end.directory))

# Damage.
older = ["step_0000000030"]
for kind in ("truncated", "a bit turned", "removed"):
    for victim in [path.name for path in files_of_newest(test.run(CASE, WRITES).directory)]:
        copy = test.new_directory(CASE)
        shutil.copytree(clock.directory, copy)
        file = copy / "checkpoints" / "step_0000000040" / victim
        content = bytearray(file.read_bytes())
        content[len(content) // 2] ^= 4
        if kind == "removed":
            file.unlink()
        else:
            file.write_bytes(content[:len(content) // 3] if kind == "truncated" else content)
        again = test.run(CASE, WRITES, 1, ["--restart"], 0, copy)
        test.check(f"{victim} {kind}: named, and the next older one taken",
                   victim in again.text and "cannot be used" in again.text
                   and "going on from" in again.text and "step 39," in again.text
                   and statistics(copy) == statistics(clock.directory))

copy = test.new_directory(CASE)
shutil.copytree(whole.directory, copy)
for path in (copy / "checkpoints").glob("*/manifest.json"):
    path.write_text("{}")
none = test.run(CASE, WRITES, 1, ["--restart"], 2, copy)
test.check("if all are damaged, nothing is run", "no checkpoint to go on from" in none.text)
nothing = test.run(CASE, WRITES, 1, ["--restart"], 2)
test.check("nor if there is none, and no folder is made",
           "no checkpoint to go on from" in nothing.text and not nothing.directory.exists())

# A folder that cannot be written, a full disk.
blocked = test.new_directory(CASE)
blocked.mkdir()
(blocked / "checkpoints").write_text("in the way")
result = test.run(CASE, WRITES, 1, (), 0, blocked)
test.check("a folder that can't be made: named, and the run goes on",
           "a checkpoint could not be written" in result.text and "Not a directory" in result.text
           and statistics(blocked) == statistics(clock.directory))
# MPI itself writes files of some megabytes.
full, limit = test.new_directory(CASE), 16000000
result = test.run("water_entry/water_entry.prm",
                  {"End time": "0.2 ms", "Bodies/water/Particle spacing": "3 mm",
                   "Bodies/wedge/Mesh/Position": "1, 1.003", "Checkpoint/Interval in steps": 3},
                  1, (), 0, full, restore_signals=False,
                  preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)))
test.check("a full disk: named, the run goes on, nothing is left",
           "a checkpoint could not be written" in result.text and "File too large" in result.text
           and names(full) == [])

# Another case.
other = test.run(CASE, {**WRITES, "Grid/Cell size": "50 mm", "Bodies/plate/Friction": 0.1}, 1,
                 ["--restart"], 2, whole.directory)
test.check("what may not change is named with both values",
           "Grid/Cell size: was '100 mm', is '50 mm'" in other.text
           and "Bodies/plate/Friction: was '0', is '0.1'" in other.text)
test.check("the same in other units is the same",
           "changed" not in test.run(CASE, {**WRITES, "End time": "0.012 s"}, 1, ["--restart"], 0,
                                     whole.directory).text)
fresh = test.run(CASE, SHORT, 1, (), 0, whole.directory)
test.check("a run from the start sets old checkpoints aside",
           "checkpoints.old" in fresh.text and names(whole.directory) == [])
test.finish()
