#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Strong and weak scaling of a case, and what its ranks send to each other.

    benchmarks/scaling.py build/release [--ranks 1 2] [--milliseconds 1] [--spacing 5] [-o FOLDER]

The case is the wedge that falls into water, as a slab in space (prm/water_entry_3d), in contact from the first step:
strong, a slab of fixed thickness; weak, one whose thickness grows with the ranks. Each is run to two end times; what is
told is the difference over the steps between, so that set-up is left out:

    ms a step     wall-clock time of the step's lines of the timing table, and of its parts
    processor     user time of all ranks, ms a step; what ranks spend waiting is in it in part
    messages, kB  that all ranks hand to MPI a step, counted by benchmarks/count_messages.cc (target count_messages) in
                  a run of its own: point to point, reductions, all-to-all, other collectives

Times mean something only on an idle machine with a core for each rank; counts always do.
"""
import argparse
import os
import pathlib
import re
import resource
import subprocess
import sys

TOP = pathlib.Path(__file__).resolve().parent.parent
PARTS = {
    "particles": ["particles to grid", "predictor", "move", "particle stress", "locate"],
    "contact": ["contact search", "contact solve", "continuous check", "penetration audit"],
    "rest": ["time step", "field split", "structure forces", "element stress", "adapt", "checks"],
}
KINDS = ["message", "reduction", "all to all", "other collective"]


def settings(options, thickness, end, folder):
    z = f"{1e-3 * thickness:g}"
    return {
        "Grid/Upper corner": f"2, 1.6, {z}",
        "Bodies/water/Upper corner": f"2, 1, {z}",
        "Bodies/water/Particle spacing": f"{options.spacing} mm",
        "Bodies/wedge/Mass": f"{0.241 * thickness} kg",
        "Bodies/wedge/Mesh/Length": f"{thickness + 40} mm",
        "End time": f"{end} ms",
        "Output/Directory": folder,
        "Output/Particle format": "none",
        "Output/Structures": "false",
        "Output/Statistics interval": "100 ms",
        **dict(text.split("=", 1) for text in options.set),
    }


def run(options, n_ranks, thickness, end, count):
    """Steps, particles, seconds by line of the timing table, calls and bytes by kind."""
    folder = options.output / f"{n_ranks}_{thickness}_{end}"
    arguments = [str(options.build / "coracle"), str(TOP / "prm/water_entry_3d/water_entry_3d.prm")]
    for key, value in settings(options, thickness, end, folder).items():
        arguments += ["--set", f"{key}={value}"]
    launch = ["mpirun", "-q", "--oversubscribe", "-n", str(n_ranks)]
    if count:
        launch += ["-x", f"LD_PRELOAD={options.build / 'benchmarks/libcount_messages.so'}"]
    environment = {**os.environ, "OMPI_MCA_mpi_yield_when_idle": "1", "OMPI_ALLOW_RUN_AS_ROOT": "1",
                   "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    done = subprocess.run(launch + arguments, env=environment, capture_output=True, text=True)
    if done.returncode not in (0, 1):
        sys.exit(f"{' '.join(launch + arguments)}\nends with {done.returncode}:\n{done.stdout}{done.stderr}")
    text = done.stdout
    processor = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    steps = int(re.search(r"^(\d+) steps to", text, re.M).group(1))
    particles = int(re.search(r"particles +(\d+) present", text).group(1))
    seconds = {name.strip(): float(s) for name, s in re.findall(r"^  ([a-z ]+?) {2,}\d+ +([\d.]+) +[\d.]+ %", text, re.M)}
    sent = {kind: [float(x) for x in numbers.split()] for kind, numbers in re.findall(r"^MPI, ([a-z ]+): (.*)$", text, re.M)}
    return steps, particles, {**seconds, "processor": processor}, sent


def per_step(options, n_ranks, thickness, count):
    short, long = (run(options, n_ranks, thickness, end, count) for end in (options.milliseconds, 2 * options.milliseconds))
    steps = long[0] - short[0]
    seconds = {name: (s - short[2].get(name, 0)) / steps for name, s in long[2].items()}
    sent = {kind: [(a - b) / steps for a, b in zip(numbers, short[3][kind])] for kind, numbers in long[3].items()}
    return long[1], seconds, sent


def table(options, title, thickness_of):
    print(f"\n{title}\n")
    print("| ranks | particles | ms a step | particles' | contact's | rest | processor | " + " | ".join(f"{k}: number, kB" for k in KINDS) +
          " | most of a rank: messages, kB |")
    print("|" + "---|" * (8 + len(KINDS)))
    for n_ranks in options.ranks:
        particles, seconds, _ = per_step(options, n_ranks, thickness_of(n_ranks), False)
        sent = per_step(options, n_ranks, thickness_of(n_ranks), True)[2]
        parts = [1e3 * sum(seconds.get(name, 0) for name in names) for names in PARTS.values()]
        cells = [f"{n_ranks}", f"{particles}", f"{sum(parts):.2f}"] + [f"{part:.2f}" for part in [*parts, 1e3 * seconds["processor"]]]
        cells += [f"{sent[kind][0]:.1f}, {sent[kind][1] / 1e3:.1f}" for kind in KINDS]
        cells += [f"{sent['message'][2]:.1f}, {sent['message'][3] / 1e3:.1f}"]
        print("| " + " | ".join(cells) + " |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--ranks", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--thickness", type=int, default=40, help="of the slab, strong; of a rank, weak [mm]")
    parser.add_argument("--spacing", type=float, default=5, help="of particles [mm]")
    parser.add_argument("--milliseconds", type=float, default=1)
    parser.add_argument("--set", action="append", default=[], metavar="Section/Key=value")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=pathlib.Path("output/scaling"))
    options = parser.parse_args()
    options.build = options.build.resolve()
    table(options, "strong", lambda n_ranks: options.thickness)
    table(options, "weak", lambda n_ranks: options.thickness * n_ranks)


if __name__ == "__main__":
    main()
