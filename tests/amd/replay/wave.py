# SPDX-License-Identifier: MIT
"""One wave: its registers, which of its lanes are on, and its way through the instructions."""
import numpy as np
import memory
import scalar_instructions
import vector_instructions
from assembly import UnknownInstruction, common_name, parse_instruction
from operands import EXEC, VCC, WORD

VECTOR_REGISTERS, SCALAR_REGISTERS = 256, 128

# What orders memory accesses, hints, and the like: an instruction here ends before the next one begins, and there are
# no caches.
_WITHOUT_EFFECT = {
    "s_waitcnt", "s_waitcnt_depctr", "s_waitcnt_vscnt", "s_wait_loadcnt", "s_wait_storecnt", "s_wait_dscnt",
    "s_wait_kmcnt", "s_wait_alu", "s_wait_loadcnt_dscnt", "s_wait_storecnt_dscnt", "s_wait_samplecnt",
    "s_wait_bvhcnt", "s_wait_expcnt", "s_delay_alu", "s_clause", "s_nop", "v_nop", "s_sendmsg",
    "s_set_inst_prefetch_distance", "s_inst_prefetch", "s_prefetch_inst", "s_setprio", "buffer_gl0_inv",
    "buffer_gl1_inv", "buffer_inv", "buffer_wbl2", "buffer_wbinvl1", "buffer_wbinvl1_vol", "global_inv", "global_wb",
    "s_dcache_inv"}
_CONDITIONS = {
    "s_branch": lambda wave: True,
    "s_cbranch_scc0": lambda wave: not wave.scc,
    "s_cbranch_scc1": lambda wave: wave.scc,
    "s_cbranch_execz": lambda wave: not wave.any_lane(),
    "s_cbranch_execnz": lambda wave: wave.any_lane(),
    "s_cbranch_vccz": lambda wave: not wave.mask_at(VCC),
    "s_cbranch_vccnz": lambda wave: wave.mask_at(VCC),
}
RUNNING, AT_BARRIER, ENDED = "running", "at a barrier", "ended"


class Wave:
    """Registers start as noise: what a kernel reads without having written it shows.

    `number` and `group` count from 1, `barriers` are those passed, likewise.
    """

    def __init__(self, instructions, wave_size, memory_, local, noise, number, group):
        self.instructions, self.wave_size, self.memory, self.local = instructions, wave_size, memory_, local
        self.number, self.group, self.barriers = number, group, 1
        self.vectors = noise.integers(0, 1 << 32, (VECTOR_REGISTERS, wave_size), dtype=np.uint32)
        self.floats = self.vectors.view(np.float32)
        self.scalars = noise.integers(0, 1 << 32, SCALAR_REGISTERS).tolist()
        self.scc, self.place, self.state = 0, 0, RUNNING
        self._bit = np.arange(wave_size, dtype=np.uint64)
        self.all_lanes = 0  # those that the launch has work-items for

    def start(self, work_items):
        self.all_lanes = (1 << work_items) - 1
        self.set_exec(self.all_lanes)

    # Lane masks

    def lanes_of(self, mask):
        return (np.uint64(mask) >> self._bit & np.uint64(1)).astype(bool)

    def mask_of(self, lanes):
        """The bits of the lanes that are on; the others' are 0."""
        return int.from_bytes(np.packbits(lanes & self.on, bitorder="little").tobytes(), "little")

    def mask_at(self, register):
        mask = self.scalars[register]
        return mask | self.scalars[register + 1] << 32 if self.wave_size == 64 else mask

    def exec_mask(self):
        return self.mask_at(EXEC)

    def set_exec(self, mask):
        self.scalars[EXEC] = mask & WORD
        if self.wave_size == 64:
            self.scalars[EXEC + 1] = mask >> 32
        self.take_exec()

    def take_exec(self):
        """After exec was written."""
        self.on = self.lanes_of(self.exec_mask())
        self._all_on = bool(self.on.all())

    def restrict(self, lanes):
        self.set_exec(self.mask_of(lanes))

    def any_lane(self):
        return bool(self.on.any())

    def first_lane(self):
        """The first that is on; lane 0 where none is."""
        return int(np.argmax(self.on))

    # Vector registers

    def chosen(self, values):
        """Of the lanes that are on."""
        return np.broadcast_to(values, (self.wave_size,))[self.on]

    def write(self, register, values):
        """One value a lane, or one for all; lanes that are off keep theirs."""
        if self._all_on:
            self.vectors[register] = values
        else:
            np.copyto(self.vectors[register], values, where=self.on)

    def write_chosen(self, register, values):
        """One value for each lane that is on."""
        self.vectors[register][self.on] = values

    def run(self, limit):
        """Up to `limit` instructions, less where a barrier or the end comes first. How many they were."""
        count = 0
        while count < limit and self.state == RUNNING:
            instruction = self.instructions[self.place]
            if instruction.action is None:
                instruction.action = decode(instruction, self.wave_size)
            self.place += 1
            count += 1
            instruction.executed += 1
            instruction.action(self)
        return count


def _branch(instruction, condition):
    def execute(wave):
        if condition(wave):
            wave.place = instruction.target
    return execute


def _enter(state):
    def execute(wave):
        wave.state = state
    return execute


def decode(instruction, wave_size):
    """What an instruction does to a wave. Raises UnknownInstruction, which names it."""
    name = common_name(instruction.mnemonic)
    if "::" in instruction.text:
        halves = [parse_instruction(half.strip()) for half in instruction.text.split("::")]
        return vector_instructions.decode(instruction, halves, wave_size)
    if name in _WITHOUT_EFFECT or name == "s_barrier_signal":  # the wait for it follows, with nothing in between
        return lambda wave: None
    if name in _CONDITIONS:
        return _branch(instruction, _CONDITIONS[name])
    if name in ("s_barrier", "s_barrier_wait"):
        return _enter(AT_BARRIER)
    if name == "s_endpgm":
        return _enter(ENDED)
    action = memory.decode(instruction, wave_size)
    if not action and name.startswith("s_"):
        action = scalar_instructions.decode(instruction)
    if not action and name.startswith("v_"):
        action = vector_instructions.decode(instruction, None, wave_size)
    if not action:
        raise UnknownInstruction(instruction.text)
    return action
