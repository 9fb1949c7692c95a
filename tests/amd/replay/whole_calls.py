# SPDX-License-Identifier: MIT
"""Whole calls: a launch gets what the one before it left, as on a device, in several orders of waves and groups."""
import hashlib

from comparison import WHOLE_CALL_TOLERANCE, compare
from launch import Schedule
from recording import RecordedBuffer

# The last launch of a call: it writes the caller's positions and velocities.
_RESULTS = ("update_velocities", "store_step", "filter_in_one_group")


def _follow(compiled, launches, schedule, races):
    """Executes the launches of a scenario one after another. Instructions, the contents of all buffers at the end, and
    lines on results that are not pocl's."""
    held, last, executed, wrong = {}, {}, 0, []
    for launch in launches:
        buffers = {a.number: a for a in launch.arguments if isinstance(a, RecordedBuffer)}
        for number, buffer in buffers.items():
            if last.get(number) != buffer.before:  # the host wrote to it in between, or it is new
                held.pop(number, None)
        executed += compiled.execute(launch, held, schedule, races)
        last.update({number: buffer.after for number, buffer in buffers.items()})
        if launch.kernel in _RESULTS:
            wrong += [f"{launch}: {line}" for line in _differences(compiled, launch, held)]
    return executed, held, wrong


def _differences(compiled, launch, held):
    lines = []
    for argument, described in zip(launch.arguments, compiled.kernel(launch).arguments):
        if isinstance(argument, RecordedBuffer) and described.type_name == "float*":
            lines += compare(compiled.kernels, argument.after.read_bytes(), held[argument.number], "float*",
                             WHOLE_CALL_TOLERANCE)[1]
    return lines


def _digest(held):
    digest = hashlib.sha256()
    for number in sorted(held):
        digest.update(held[number])
    return digest.hexdigest()[:16]


def check(compiled, scenario, launches, seeds, quantum, races):
    """Wave instructions, and lines on what is wrong: results, races, and bytes that depend on the order of waves."""
    found = set() if races else None
    executed, held, wrong = _follow(compiled, launches, Schedule(), found)
    in_order = _digest(held)
    for seed in seeds:
        more, held, _ = _follow(compiled, launches, Schedule(seed, quantum), found)
        executed += more
        if _digest(held) != in_order:
            wrong.append(f"{scenario}: other bytes with the random order of seed {seed}")
    print(f"{scenario} {compiled.target}: {len(launches)} launches, {1 + len(seeds)} orders, all bytes {in_order}",
          flush=True)
    return executed, wrong + [f"{scenario}: race: {race}" for race in sorted(found or ())]
