# SPDX-License-Identifier: MIT
"""Runs the scenarios on pocl under the recorder and leaves a folder of launches for each.

Exit status: 0 all were recorded; 1 one failed; 2 wrong usage.
"""
import argparse
import os
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenarios", nargs="*", help="names; all small ones where none is given")
    parser.add_argument("--program", type=Path, required=True, help="apsl_replay_scenarios")
    parser.add_argument("--recorder", type=Path, required=True, help="libapsl_launch_recorder.so")
    parser.add_argument("--recordings", type=Path, required=True, help="folder to write to")
    parser.add_argument("--further", action="store_true", help="the further scenarios too")
    parser.add_argument("--jobs", type=int, default=2, help="scenarios at a time")
    return parser.parse_args()


def names(program, *options):
    return subprocess.run([program, *options], check=True, capture_output=True, text=True).stdout.split()


def record(arguments, scenario):
    """Status and output of one scenario."""
    folder = arguments.recordings / scenario
    shutil.rmtree(folder, ignore_errors=True)
    # The device is pocl's, one thread of it: an order of groups that is always the same.
    environment = {**os.environ, "LD_PRELOAD": str(arguments.recorder.resolve()), "APSL_RECORDING": str(folder),
                   "APSL_TEST_PLATFORM": "Portable", "OCL_ICD_VENDORS": "/etc/OpenCL/vendors/pocl.icd",
                   "POCL_MAX_PTHREAD_COUNT": "1"}
    result = subprocess.run([arguments.program, scenario], env=environment, capture_output=True, text=True, timeout=600)
    return result.returncode, result.stdout + result.stderr


def main():
    arguments = parse_arguments()
    arguments.recordings.mkdir(parents=True, exist_ok=True)
    if not arguments.scenarios:
        for folder in arguments.recordings.iterdir():  # of scenarios that are no more
            if (folder / "index.txt").exists():
                shutil.rmtree(folder)
    scenarios = arguments.scenarios or names(arguments.program) + (
        names(arguments.program, "--further") if arguments.further else [])
    failed = 0
    with ThreadPoolExecutor(arguments.jobs) as pool:
        for scenario, (status, output) in zip(scenarios, pool.map(lambda s: record(arguments, s), scenarios)):
            print(output, end="")
            if status != 0:
                print(f"refused: {scenario} ended with status {status}", file=sys.stderr)
                failed += 1
    print(f"recorded: {len(scenarios) - failed} of {len(scenarios)} scenarios")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
