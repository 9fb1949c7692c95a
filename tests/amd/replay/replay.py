# SPDX-License-Identifier: MIT
"""Executes recorded launches as AMD machine code and compares each with what pocl computed.

Exit status: 0 all agree; 1 some do not, one line each on standard error; 2 wrong usage or no compiler.
"""
import argparse
import sys
import time
from pathlib import Path

try:
    import numpy  # noqa: F401
except ImportError:
    sys.exit("error: numpy was not found, expected it for /usr/bin/python3 (Debian: python3-numpy)")

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import amd_compiler  # noqa: E402
import check_kernels  # noqa: E402
import coverage  # noqa: E402
import variants  # noqa: E402
import whole_calls  # noqa: E402
from assembly import UnknownInstruction, common_name  # noqa: E402
from comparison import LEFT_BY_SOLVES, compare, compare_partials, tolerance_of  # noqa: E402
from compiled import Compiled  # noqa: E402
from launch import Schedule  # noqa: E402
from memory import Fault  # noqa: E402
from recording import BadRecording, RecordedBuffer, contents, launches_of  # noqa: E402


def replay(compiled, launch, schedule=Schedule(), races=False):
    """Executes one recorded launch from what its buffers held. Wave instructions executed, the greatest difference of
    floats as a share, and lines on what is wrong."""
    held, found = {}, set() if races else None
    try:
        executed = compiled.execute(launch, held, schedule, found)
    except amd_compiler.CompileError as error:
        return 0, 0.0, [f"compile: {error}"]
    except UnknownInstruction as error:
        return 0, 0.0, [f"unknown instruction: {error}"]
    except Fault as error:
        return 0, 0.0, [f"fault: {error}"]
    wrong, greatest = [f"race: {race}" for race in sorted(found or ())], 0.0
    for number, (argument, described) in enumerate(zip(launch.arguments, compiled.kernel(launch).arguments)):
        if isinstance(argument, RecordedBuffer) and described.name not in LEFT_BY_SOLVES.get(launch.kernel, ()):
            buffers, tolerance = (contents(argument.after), held[argument.number]), tolerance_of(launch.kernel)
            if described.name == "partials":
                share, lines = compare_partials(compiled.kernels, *buffers, launch.grid.cloths, tolerance)
            else:
                share, lines = compare(compiled.kernels, *buffers, described.type_name, tolerance)
            greatest = max(greatest, share)
            wrong += [f"argument {number}, {described.name}: {line}" for line in lines]
    return executed, greatest, wrong


def has_work(launch):
    """Whether it changed anything: launches queued for iterations that are no longer needed do not."""
    return any(argument.before != argument.after for argument in launch.arguments
               if isinstance(argument, RecordedBuffer))


def few(launches, compiled):
    """Launches with work that between them have every kernel with every setting that the recordings have."""
    return coverage.enough([(launch, compiled.defines_of(launch)) for launch in launches if has_work(launch)])


def target_named(name):
    for target in variants.TARGETS:
        if str(target) == name:
            return target
    raise argparse.ArgumentTypeError(f"{name}, expected one of {', '.join(map(str, variants.TARGETS))}")


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenarios", nargs="*",
                        help="names of recordings; without any all of them, and every kernel and setting must be there")
    parser.add_argument("--recordings", type=Path, required=True, help="folder that record.py wrote")
    parser.add_argument("--target", type=target_named, action="append", help="gfx906/64 …; all where none is given")
    parser.add_argument("--kernels", type=Path, default=check_kernels.PROJECT / "kernels", help="folder of the sources")
    parser.add_argument("--kernel", help="launches of this kernel alone")
    parser.add_argument("--all", action="store_true",
                        help="every launch, not just enough for every kernel and setting of it")
    parser.add_argument("--whole-calls", action="store_true",
                        help="every launch, from what the one before it left; compares what the calls leave, and all "
                             "bytes between orders of waves and groups")
    parser.add_argument("--orders", type=int, default=2, help="with --whole-calls: random orders beside the plain one")
    parser.add_argument("--races", action="store_true", help="look for races")
    parser.add_argument("--seed", type=int, default=1, help="of noise in registers, and of random schedules")
    parser.add_argument("--quantum", type=int, default=0, metavar="N",
                        help="all groups at once, waves by turns at random of up to N instructions")
    parser.add_argument("--clang", default="clang-19")
    parser.add_argument("--device-libraries", type=Path, default=check_kernels.device_libraries(),
                        help="folder of ocml.bc")
    arguments = parser.parse_args()
    check_kernels.require_compiler(parser, arguments)
    if not arguments.recordings.is_dir():
        parser.error(f"{arguments.recordings} is no folder, expected what record.py wrote")
    return arguments


def print_kernels(figures):
    print(f"{'launches':>9}{'instructions':>14}{'difference':>12}{'seconds':>9}  kernel")
    for name, (launches, executed, greatest, seconds) in sorted(figures.items()):
        print(f"{launches:9}{executed:14}{greatest:12.1e}{seconds:9.1f}  {name}")


def mnemonics(instructions):
    """Of a pair that is issued together both."""
    return {common_name(half.split(" ")[0]) for instruction in instructions for half in instruction.text.split(" :: ")}


def print_instructions(compiled):
    code = [instruction for kernel in compiled.all_kernels() for instruction in kernel.instructions]
    known, met = mnemonics(code), mnemonics(instruction for instruction in code if instruction.executed)
    places = sum(1 for instruction in code if instruction.executed)
    print(f"{compiled.target}: {len(met)} of {len(known)} mnemonics and {places} of {len(code)} instructions of the "
          "compiled kernels executed")
    if known - met:
        print(f"{compiled.target}: never executed: {', '.join(sorted(known - met))}")


def replay_launches(arguments, compiled, launches):
    """Each from its own recording. Lines on what is wrong."""
    schedule = Schedule(arguments.seed, arguments.quantum)
    refused, figures, done = [], {}, []
    for launch in launches if arguments.all else few(launches, compiled):
        begun = time.monotonic()
        executed, greatest, wrong = replay(compiled, launch, schedule, arguments.races)
        refused += [f"{launch} {compiled.target}: {line}" for line in wrong]
        figure = figures.setdefault(launch.kernel, [0, 0, 0.0, 0.0])
        figure[:] = (figure[0] + 1, figure[1] + executed, max(figure[2], greatest),
                     figure[3] + time.monotonic() - begun)
        if executed > 0:
            done.append((launch, compiled.defines_of(launch)))
    print_kernels(figures)
    print(f"{compiled.target}: {sum(f[0] for f in figures.values())} launches of {len(figures)} kernels, "
          f"{sum(f[1] for f in figures.values())} wave instructions")
    if not arguments.scenarios and not arguments.kernel:
        refused += [f"{compiled.target}: coverage: {line}" for line in coverage.missing(arguments.kernels, done)]
        print(f"{compiled.target}: {coverage.summary(arguments.kernels, done)}")
    return refused


def follow_calls(arguments, compiled, launches):
    """Every scenario from its first launch to its last. Lines on what is wrong."""
    refused = []
    seeds = range(arguments.seed, arguments.seed + arguments.orders)
    for scenario in dict.fromkeys(launch.scenario for launch in launches):
        of_it = [launch for launch in launches if launch.scenario == scenario]
        try:
            _, wrong = whole_calls.check(compiled, scenario, of_it, seeds, arguments.quantum or 60, arguments.races)
        except (amd_compiler.CompileError, UnknownInstruction, Fault) as error:
            wrong = [f"{scenario}: {type(error).__name__}: {error}"]
        refused += [f"{compiled.target}: {line}" for line in wrong]
    return refused


def main():
    arguments = parse_arguments()
    folders = [arguments.recordings / name for name in arguments.scenarios] or sorted(
        folder for folder in arguments.recordings.iterdir() if folder.is_dir())
    try:
        launches = [launch for folder in folders for launch in launches_of(folder)
                    if arguments.kernel in (None, launch.kernel)]
    except BadRecording as error:
        print(f"refused: {error}", file=sys.stderr)
        return 1
    refused = []
    for target in arguments.target or variants.TARGETS:
        begun = time.monotonic()
        compiled = Compiled(arguments.clang, arguments.device_libraries, arguments.kernels, target)
        refused += (follow_calls if arguments.whole_calls else replay_launches)(arguments, compiled, launches)
        print_instructions(compiled)
        print(f"{target}: {time.monotonic() - begun:.0f} s", flush=True)
    for line in refused:
        print(f"refused: {line}", file=sys.stderr)
    return 1 if refused else 0


if __name__ == "__main__":
    sys.exit(main())
