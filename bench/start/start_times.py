#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""How long the limiter takes to start: construction and first call, from source and from a program binary, with the
driver's own cache empty and filled. Every start is a process of its own; the ways to start take turns. Prints a table
in Markdown, milliseconds, medians.

The driver's cache is a folder of this script's (POCL_CACHE_DIR, CUDA_CACHE_PATH); other drivers keep their own."""

import argparse
import json
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

# What the row says; the binary started from; the driver's cache before the start.
STARTS = (
    ("from source, nothing cached", None, "empty"),
    ("from source, the driver's cache filled", None, "filled"),
    ("from the binary, the driver's cache filled", "after", "filled"),
    ("from the binary, nothing cached", "after", "empty"),
    ("the same, the driver's cache in memory", "after", "memory"),
    ("the same, POCL_KERNEL_CACHE=0", "after", "off"),
    ("from a binary asked for before the first call, nothing cached", "before", "empty"),
)
COLUMNS = (("construction", "construction_seconds"), ("of it program", "program_seconds"),
           ("of it buffers", "buffer_seconds"), ("first call", "first_call_seconds"),
           ("second call", "second_call_seconds"))


def start(command, cache, *more):
    environment = dict(os.environ, POCL_CACHE_DIR=str(cache), CUDA_CACHE_PATH=str(cache))
    if cache.name == "off":
        environment["POCL_KERNEL_CACHE"] = "0"
    done = subprocess.run([*command, *more], env=environment, capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(map(str, command))}: {done.stderr.strip()}")
    return json.loads(done.stdout)


def measure(command, folder, memory, repetitions):
    """{row: [one start's figures]}, and the figures of the starts that kept a binary."""
    binaries = {"after": folder / "after.binary", "before": folder / "before.binary"}
    kept = {"after": start(command, folder / "filled", "--keep", binaries["after"]),
            "before": start(command, folder / "before", "--keep", binaries["before"], "--ask-before-call")}
    possible = [one for one in STARTS if one[1] is None or kept["after"]["binary_bytes"] > 0]
    figures = {row: [] for row, _, _ in possible}
    for _ in range(repetitions):
        for row, binary, cache in possible:
            place = memory if cache == "memory" else folder / cache
            if cache != "filled":
                shutil.rmtree(place, ignore_errors=True)
                place.mkdir()
            one = start(command, place, *(("--binary", binaries[binary]) if binary else ()))
            if one["binary_taken"] != (binary is not None):
                raise SystemExit(f"{row}: the binary was {'not ' if binary else ''}taken")
            figures[row].append(one)
    return figures, kept


def main():
    parser = argparse.ArgumentParser(
        description="Measures starts of the limiter.", epilog="Other options are passed on to apsl_start_bench.")
    parser.add_argument("program", type=Path, help="apsl_start_bench")
    parser.add_argument("--repetitions", type=int, default=5)
    given, passed_on = parser.parse_known_args()
    with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryDirectory(dir="/dev/shm") as memory:
        figures, kept = measure([given.program, *passed_on], Path(folder), Path(memory) / "cache",
                                given.repetitions)
    until_first = {row: statistics.median(one["construction_seconds"] + one["first_call_seconds"] for one in starts)
                   for row, starts in figures.items()}
    print("| start | " + " | ".join(name for name, _ in COLUMNS) + " | until the first call is done |")
    print("|---" * (len(COLUMNS) + 2) + "|")
    for row, starts in figures.items():
        medians = (1e3 * statistics.median(one[field] for one in starts) for _, field in COLUMNS)
        share = 100.0 * until_first[row] / until_first[STARTS[0][0]]
        print(f"| {row} | " + " | ".join(f"{ms:.1f}" for ms in medians) + f" | {share:.1f} % |")
    after = kept["after"]
    if after["binary_bytes"] == 0:
        print(f"\n{after['triangles']} triangles; the driver gives no program binary, the starts from one are left out")
        return 0
    print(f"\n{after['triangles']} triangles; binary of {after['binary_bytes']} bytes, asked for in "
          f"{after['asking_seconds']:.1f} s ({kept['before']['binary_bytes']} bytes before the first call)")
    return 0


if __name__ == "__main__":
    sys.exit(main())
