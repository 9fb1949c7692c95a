#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Plants known faults into a copy of the sources, one at a time, and shows that the check named for each sees it.

    tests/planted_faults/planted_faults.py [--only WORD] [--table docs/stability/planted_faults.md]

The copy and its builds lie in build/planted_faults or where --copy says. A check must pass before the fault is planted and fail after, for
the reason stated. Exit 1 where a fault is not caught, 2 where one no longer fits the sources.
"""
import argparse
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from faults import FAULTS

ROOT = Path(__file__).resolve().parents[2]
BEGIN, END = "<!-- table of planted_faults.py -->", "<!-- end of table -->"


class Misfit(Exception):
    """A fault that cannot be planted, or a check that fails without it; one line."""


def copy_sources(copy):
    """The files that git knows or would add; unchanged ones keep their times, so that builds are not made anew."""
    copy.mkdir(parents=True, exist_ok=True)
    listed = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard"], cwd=ROOT, check=True,
                            capture_output=True, text=True).stdout.split("\n")
    for name in filter(None, listed):
        source, target = ROOT / name, copy / name
        if not source.exists():
            target.unlink(missing_ok=True)
        elif not target.exists() or target.read_bytes() != source.read_bytes():
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(source, target)


def build(check, copy):
    if not check.target:
        return
    configure = "asan" if check.preset.startswith("asan") else check.preset
    for command in (["cmake", "--preset", configure], ["cmake", "--build", f"build/{configure}", "--target", check.target]):
        result = subprocess.run(command, cwd=copy, capture_output=True, text=True)
        if result.returncode != 0:
            raise Misfit(f"{' '.join(command)} failed in {copy}:\n{result.stdout[-3000:]}{result.stderr[-3000:]}")


def run(check, copy):
    """Exit code and output. Two minutes past any time limit of the tests it counts as failed."""
    result = subprocess.run(check.command, cwd=copy, capture_output=True, text=True, timeout=900,
                            errors="replace", env={**os.environ, "PYTHONDONTWRITEBYTECODE": "1"})
    return result.returncode, result.stdout + result.stderr


def planted(fault, copy):
    path = copy / fault.file
    text = path.read_text(encoding="utf-8")
    if text.count(fault.old) != 1:
        raise Misfit(f"{fault.file}: {text.count(fault.old)} places read {fault.old!r}, expected one: {fault.what}")
    return path, text, text.replace(fault.old, fault.new)


def is_caught(fault, passed, copy):
    """Whether the check fails with the fault, for the reason stated, and passes without it."""
    path, whole, faulty = planted(fault, copy)
    if fault.check not in passed:
        build(fault.check, copy)
        code, output = run(fault.check, copy)
        if code != 0:
            raise Misfit(f"{fault.check.name} ({' '.join(fault.check.command)}) fails without a fault:\n{output[-3000:]}")
        passed.add(fault.check)
    path.write_text(faulty, encoding="utf-8")
    try:
        build(fault.check, copy)
        code, output = run(fault.check, copy)
    finally:
        path.write_text(whole, encoding="utf-8")
        build(fault.check, copy)  # a program that holds a fault must not be left to be run by hand
    if code != 0 and re.search(fault.says, output):
        return True
    print(f"  not caught: exit code {code}, {fault.says!r} "
          f"{'is' if re.search(fault.says, output) else 'is not'} in what it says:\n{output[-2000:]}", file=sys.stderr)
    return False


def write_table(path, caught):
    rows = ["| fault | where | caught by |", "|---|---|---|"]
    rows += [f"| {fault.what} | `{fault.file}` | {fault.check.name} |" for fault in caught]
    text = path.read_text(encoding="utf-8")
    before, rest = text.split(BEGIN)
    after = rest.split(END)[1]
    path.write_text(before + BEGIN + "\n" + "\n".join(rows) + "\n" + END + after, encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="", help="the faults or checks with this in their names")
    parser.add_argument("--table", type=Path, help="a document to put the table into, between its markers")
    parser.add_argument("--copy", type=Path, default=ROOT / "build" / "planted_faults", help="where to build")
    arguments = parser.parse_args()
    chosen = [fault for fault in FAULTS if arguments.only in fault.what + fault.check.name + fault.file]
    if not chosen:
        parser.error(f"no fault has {arguments.only!r} in its name")
    if arguments.table and len(chosen) < len(FAULTS):
        parser.error("--table wants all faults, without --only")
    copy_sources(arguments.copy)
    caught, passed = [], set()
    try:
        for number, fault in enumerate(chosen, 1):
            print(f"{number}/{len(chosen)} {fault.what}", flush=True)
            if is_caught(fault, passed, arguments.copy):
                print(f"  caught by: {fault.check.name}", flush=True)
                caught.append(fault)
    except Misfit as misfit:
        print(f"error: {misfit}", file=sys.stderr)
        return 2
    print(f"{len(caught)} of {len(chosen)} faults caught")
    if len(caught) < len(chosen):
        return 1
    if arguments.table:
        write_table(arguments.table, caught)
    return 0


if __name__ == "__main__":
    sys.exit(main())
