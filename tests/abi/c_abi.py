#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""The binary interface of libapsl.so's C functions, against the committed baseline tests/abi/c_interface.abi.

  c_abi.py check LIBRARY   exit 0 where nothing changed, 1 with abidiff's report where something did
  c_abi.py renew LIBRARY   writes the baseline anew

LIBRARY needs debug information (-g). Enumerators that only integers carry (apsl_matrix and the like) leave no trace in a
library: they are read from apsl.h and kept in tests/abi/c_enumerators.txt.
"""
import argparse
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
HEADERS = HERE.parents[1] / "include"
BASELINE = HERE / "c_interface.abi"
ENUMERATORS = HERE / "c_enumerators.txt"


def dump(library, baseline, headers=HEADERS):
    """Writes the C interface of a shared library as abidw sees it, without paths, so that it is the same anywhere."""
    with tempfile.TemporaryDirectory() as folder:
        # Types count as the interface's by the name of the file they come from: this one alone.
        shutil.copy(Path(headers) / "apsl" / "apsl.h", folder)
        subprocess.run(
            ["abidw", "--headers-dir", folder, "--drop-private-types", "--exported-interfaces-only",
             "--suppressions", str(HERE / "suppressions.ini"), "--no-comp-dir-path", "--no-show-locs", "--no-corpus-path",
             "--no-elf-needed", "--type-id-style", "hash", "--out-file", str(baseline), str(library)], check=True)
    text = Path(baseline).read_text()
    Path(baseline).write_text(re.sub(r" path='[^']*/", " path='", text))


def enumerators(headers=HEADERS):
    """Every enumerator of apsl.h with its value, a line each."""
    text = (Path(headers) / "apsl" / "apsl.h").read_text()
    return "".join(f"{name} {value}\n" for name, value in re.findall(r"\b(APSL_\w+) = (\d+)", text))


def report(library, headers=HEADERS, baseline=BASELINE):
    """What changed since the baseline: abidiff's report and changed enumerators, empty where nothing did."""
    with tempfile.TemporaryDirectory() as folder:
        now = Path(folder) / "now.abi"
        dump(library, now, headers)
        run = subprocess.run(["abidiff", "--harmless", "--no-show-locs", str(baseline), str(now)], capture_output=True, text=True)
    if run.returncode & 3:  # its own errors; 4 and 8 are changes
        raise RuntimeError(f"abidiff {baseline}: {run.stderr.strip() or run.stdout.strip()}")
    before, after = set(ENUMERATORS.read_text().splitlines()), set(enumerators(headers).splitlines())
    changes = [f"enumerator removed: {line}" for line in sorted(before - after)]
    changes += [f"enumerator added: {line}" for line in sorted(after - before)]
    return (run.stdout if run.returncode else "") + "\n".join(changes)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command", choices=["check", "renew"])
    parser.add_argument("library")
    arguments = parser.parse_args()
    if arguments.command == "renew":
        dump(arguments.library, BASELINE)
        ENUMERATORS.write_text(enumerators())
        return 0
    changes = report(arguments.library)
    if changes:
        print(changes)
        print(f"{arguments.library}: the C interface is not that of {BASELINE.name}. Where that is meant: "
              "cmake --build --preset ci --target apsl_renew_abi, and a line in CHANGELOG.md", file=sys.stderr)
    return 1 if changes else 0


if __name__ == "__main__":
    sys.exit(main())
