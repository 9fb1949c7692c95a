# SPDX-License-Identifier: MIT
"""Executes recorded launches as AMD machine code and compares each with what pocl computed.

Exit status: 0 all agree; 1 some do not, one line each on standard error; 2 wrong usage or no compiler.
"""
import argparse
import shutil
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

import amd_compiler  # noqa: E402
import check_kernels  # noqa: E402
import coverage  # noqa: E402
import variants  # noqa: E402
from assembly import UnknownInstruction, common_name, kernels_of  # noqa: E402
from comparison import compare  # noqa: E402
from launch import Schedule, run  # noqa: E402
from memory import DeviceMemory, Fault  # noqa: E402
from recording import BadRecording, RecordedBuffer, contents, launches_of  # noqa: E402


class Compiled:
    """Kernels of a folder of sources, compiled for a target when they are first launched."""

    def __init__(self, clang, device_libraries, kernels, target):
        self.clang, self.device_libraries, self.kernels, self.target = clang, device_libraries, kernels, target
        self._files = {}

    def defines_of(self, launch):
        """The part of the program's defines that the file reads."""
        names = variants.defines_read_by(self.kernels / launch.source)
        return tuple((name, launch.defines[name]) for name in names)

    def kernel(self, launch):
        """Raises amd_compiler.CompileError."""
        key = launch.source, self.defines_of(launch)
        if key not in self._files:
            assembly, _ = amd_compiler.compile_source(self.clang, self.device_libraries, self.kernels / launch.source,
                                                      key[1], self.target)
            self._files[key] = kernels_of(assembly)
        return self._files[key][launch.kernel]

    def all_kernels(self):
        return [kernel for file in self._files.values() for kernel in file.values()]


def replay(compiled, launch, schedule=Schedule(), races=False):
    """Executes one recorded launch from what its buffers held. Wave instructions executed, the greatest difference of
    floats as a share, and lines on what is wrong."""
    memory = DeviceMemory(set() if races else None)
    buffers, arguments = {}, []
    for argument in launch.arguments:
        if isinstance(argument, RecordedBuffer):
            if argument.number not in buffers:
                buffers[argument.number] = memory.add(contents(argument.before))
            arguments.append(buffers[argument.number].address.to_bytes(8, "little"))
        else:
            arguments.append(argument)
    try:
        kernel = compiled.kernel(launch)
        executed = run(kernel, compiled.target, memory, arguments, launch.grid, schedule)
    except amd_compiler.CompileError as error:
        return 0, 0.0, [f"compile: {error}"]
    except (UnknownInstruction, Fault) as error:
        kind = "unknown instruction" if isinstance(error, UnknownInstruction) else "fault"
        return 0, 0.0, [f"{kind}: {error}"]
    wrong = [f"race: {race}" for race in sorted(memory.races or ())]
    greatest = 0.0
    for argument, described in zip(launch.arguments, kernel.arguments):
        if isinstance(argument, RecordedBuffer):
            share, lines = compare(compiled.kernels, launch.kernel, described.type_name,
                                   buffers[argument.number].contents(), contents(argument.after))
            greatest = max(greatest, share)
            wrong += [f"{described.type_name} of argument {launch.arguments.index(argument)}: {line}" for line in lines]
    return executed, greatest, wrong


def has_work(launch):
    """Whether it changed anything: launches queued for iterations that are no longer needed do not."""
    return any(argument.before != argument.after for argument in launch.arguments
               if isinstance(argument, RecordedBuffer))


def chosen(launches, compiled, each):
    """Of every kernel and variant the first `each` launches that have work; 0: all launches."""
    if each == 0:
        return launches
    taken, result = {}, []
    for launch in launches:
        key = launch.kernel, launch.source, compiled.defines_of(launch)
        if has_work(launch) and taken.get(key, 0) < each:
            taken[key] = taken.get(key, 0) + 1
            result.append(launch)
    return result


def target_named(name):
    for target in variants.TARGETS:
        if str(target) == name:
            return target
    raise argparse.ArgumentTypeError(f"{name}, expected one of {', '.join(map(str, variants.TARGETS))}")


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenarios", nargs="*", help="names of recordings; all where none is given")
    parser.add_argument("--recordings", type=Path, required=True, help="folder that record.py wrote")
    parser.add_argument("--target", type=target_named, action="append", help="gfx906/64 …; all where none is given")
    parser.add_argument("--kernels", type=Path, default=check_kernels.PROJECT / "kernels", help="folder of the sources")
    parser.add_argument("--kernel", help="launches of this kernel alone")
    parser.add_argument("--each", type=int, default=1, metavar="N",
                        help="N launches with work of each kernel and variant; 0: every launch")
    parser.add_argument("--races", action="store_true", help="look for races")
    parser.add_argument("--seed", type=int, default=1, help="of noise in registers, and of random schedules")
    parser.add_argument("--quantum", type=int, default=0, metavar="N",
                        help="all groups at once, waves by turns at random of up to N instructions")
    parser.add_argument("--no-coverage", action="store_true", help="do not ask for every kernel and option")
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


def replay_target(arguments, target, launches):
    """Lines on what is wrong."""
    started = time.monotonic()
    compiled = Compiled(arguments.clang, arguments.device_libraries, arguments.kernels, target)
    schedule = Schedule(arguments.seed, arguments.quantum)
    refused, figures, done = [], {}, []
    for launch in chosen(launches, compiled, arguments.each):
        begun = time.monotonic()
        executed, greatest, wrong = replay(compiled, launch, schedule, arguments.races)
        refused += [f"{launch} {target}: {line}" for line in wrong]
        figure = figures.setdefault(launch.kernel, [0, 0, 0.0, 0.0])
        figure[0] += 1
        figure[1] += executed
        figure[2] = max(figure[2], greatest)
        figure[3] += time.monotonic() - begun
        if executed > 0:
            done.append((launch, compiled.defines_of(launch)))
    print_kernels(figures)
    code = [instruction for kernel in compiled.all_kernels() for instruction in kernel.instructions]
    known = {common_name(instruction.mnemonic) for instruction in code}
    met = {common_name(instruction.mnemonic) for instruction in code if instruction.executed}
    places = sum(1 for instruction in code if instruction.executed)
    print(f"{target}: {sum(f[0] for f in figures.values())} launches of {len(figures)} kernels, "
          f"{sum(f[1] for f in figures.values())} wave instructions, {time.monotonic() - started:.0f} s; "
          f"{len(met)} of {len(known)} mnemonics and {places} of {len(code)} instructions in the compiled kernels executed")
    if known - met:
        print(f"{target}: never executed: {', '.join(sorted(known - met))}")
    if not arguments.no_coverage:
        refused += [f"{target}: coverage: {line}" for line in coverage.missing(arguments.kernels, done)]
        print(f"{target}: {coverage.summary(arguments.kernels, done)}")
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
        refused += replay_target(arguments, target, launches)
    for line in refused:
        print(f"refused: {line}", file=sys.stderr)
    return 1 if refused else 0


if __name__ == "__main__":
    sys.exit(main())
