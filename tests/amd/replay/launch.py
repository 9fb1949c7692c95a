# SPDX-License-Identifier: MIT
"""One launch: work-groups, their waves, barriers, and the order in which waves take turns."""
import random
from dataclasses import dataclass

import numpy as np
from assembly import UnknownInstruction
from memory import Fault, LocalMemory
from operands import FIRST_TRAP_REGISTER, WORD
from wave import AT_BARRIER, ENDED, RUNNING, Wave

# Scalar registers that a kernel may ask for in front of its arguments' address, and behind it.
_BEFORE_ARGUMENTS = (("private_segment_buffer", 4), ("dispatch_ptr", 2), ("queue_ptr", 2))


@dataclass(frozen=True)
class Schedule:
    """Who runs when. Without `quantum` a wave runs to its next barrier, and a group to its end before the next one
    starts. Otherwise all groups at once: a wave drawn at random, for up to `quantum` instructions, and so on."""
    seed: int = 1
    quantum: int = 0


@dataclass(frozen=True)
class Grid:
    groups: int  # for each cloth
    cloths: int
    work_group_size: int


_IMPLICIT = {
    "hidden_block_count_x": lambda grid: grid.groups, "hidden_block_count_y": lambda grid: grid.cloths,
    "hidden_block_count_z": lambda grid: 1, "hidden_group_size_x": lambda grid: grid.work_group_size,
    "hidden_group_size_y": lambda grid: 1, "hidden_group_size_z": lambda grid: 1,
    "hidden_remainder_x": lambda grid: 0, "hidden_remainder_y": lambda grid: 0, "hidden_remainder_z": lambda grid: 0,
    "hidden_global_offset_x": lambda grid: 0, "hidden_global_offset_y": lambda grid: 0,
    "hidden_global_offset_z": lambda grid: 0, "hidden_grid_dims": lambda grid: 2}


def argument_block(kernel, arguments, grid):
    """What the arguments' address points to. `arguments`: the bytes of each. What nobody sets is not zero."""
    block = bytearray(b"\xa5" * kernel.argument_bytes)
    given = iter(arguments)
    for argument in kernel.arguments:
        if argument.kind in _IMPLICIT:
            value = _IMPLICIT[argument.kind](grid).to_bytes(argument.size, "little")
        elif argument.kind.startswith("hidden_"):
            continue
        else:
            value = next(given)
            if len(value) != argument.size:
                raise Fault(f"an argument of {len(value)} bytes, expected {argument.size}")
        block[argument.offset:argument.offset + argument.size] = value
    return bytes(block)


class _Group:
    """The waves of a work-group, started as the kernel's descriptor says."""

    def __init__(self, kernel, target, memory, arguments_address, grid, place, noise, first_number):
        self.kernel = kernel
        group, cloth = place
        number = 1 + group + cloth * grid.groups
        local = LocalMemory(kernel.local_bytes, memory.races)
        self.waves = []
        for start in range(0, grid.work_group_size, target.wave_size):
            wave = Wave(kernel.instructions, target.wave_size, memory, local, noise,
                        first_number + len(self.waves), number)
            self._set_scalars(wave, target, arguments_address, group, cloth)
            items = min(target.wave_size, grid.work_group_size - start)
            wave.vectors[0][:items] = np.arange(start, start + items)  # y and z, packed above x, are 0
            wave.start(items)
            self.waves.append(wave)

    def _set_scalars(self, wave, target, arguments_address, group, cloth):
        asked = self.kernel.descriptor
        register = 0
        for name, registers in _BEFORE_ARGUMENTS:
            if asked.get(f"user_sgpr_{name}"):
                register += registers
        if not asked.get("user_sgpr_kernarg_segment_ptr"):
            raise UnknownInstruction("a kernel without an address of its arguments")
        wave.scalars[register], wave.scalars[register + 1] = arguments_address & WORD, arguments_address >> 32
        if target.processor.startswith("gfx12"):
            wave.scalars[FIRST_TRAP_REGISTER + 9], wave.scalars[FIRST_TRAP_REGISTER + 7] = group, cloth
            return
        register = asked["user_sgpr_count"]
        for axis, value in (("x", group), ("y", cloth), ("z", 0)):
            if asked.get(f"system_sgpr_workgroup_id_{axis}"):
                wave.scalars[register] = value
                register += 1

    def pass_barrier(self):
        """Lets the waves go on where all have come to it. Raises Fault where some never will."""
        waiting = [wave for wave in self.waves if wave.state == AT_BARRIER]
        if not waiting or any(wave.state == RUNNING for wave in self.waves):
            return
        if len(waiting) < len(self.waves):
            raise Fault("a barrier that some waves do not come to: they have ended")
        if len({wave.place for wave in waiting}) > 1:
            raise Fault("waves wait at different barriers")
        if any(wave.exec_mask() != wave.all_lanes for wave in waiting):
            raise Fault("a barrier in a branch: some lanes are off")
        for wave in waiting:
            wave.state = RUNNING
            wave.barriers += 1


def run(kernel, target, memory, arguments, grid, schedule=Schedule()):
    """Executes a launch on the buffers in `memory`; `arguments` are the bytes of each. Wave instructions executed.

    Raises UnknownInstruction and Fault.
    """
    if kernel.scratch_bytes or kernel.descriptor.get("user_sgpr_kernarg_preload_length"):
        raise UnknownInstruction(f"{kernel.name} uses scratch memory or has arguments in registers")
    noise, draw = np.random.default_rng(schedule.seed), random.Random(schedule.seed)
    address = memory.add(argument_block(kernel, arguments, grid)).address
    places = [(group, cloth) for cloth in range(grid.cloths) for group in range(grid.groups)]
    batches = [places] if schedule.quantum else [[place] for place in places]
    executed, number = 0, 1
    with np.errstate(all="ignore"):
        for batch in batches:
            groups = []
            for place in batch:
                groups.append(_Group(kernel, target, memory, address, grid, place, noise, number))
                number += len(groups[-1].waves)
            executed += _run_groups(groups, schedule, draw)
    return executed


def _run_groups(groups, schedule, draw):
    executed = 0
    while True:
        for group in groups:
            group.pass_barrier()
        ready = [wave for group in groups for wave in group.waves if wave.state == RUNNING]
        if not ready:
            break
        if schedule.quantum:
            executed += draw.choice(ready).run(draw.randint(1, schedule.quantum))
        else:
            executed += ready[0].run(1 << 62)
    if any(wave.state != ENDED for group in groups for wave in group.waves):
        raise Fault("waves wait for ever")
    return executed
