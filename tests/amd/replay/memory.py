# SPDX-License-Identifier: MIT
"""Device memory, local memory, and the instructions that reach them. An access outside is an error."""
import re

import numpy as np
from assembly import UnknownInstruction, common_name
from operands import lanes, parse, scalar
from races import Accesses

_GAP = 1 << 16  # bytes between two buffers, at least
_START = 0x7f0000001000


class Fault(Exception):
    """What the program may not do; one line."""


class Buffer:
    """Bytes at an address that ends with the last of them."""

    def __init__(self, address, contents):
        self.address, self.size = address, len(contents)
        self.bytes = np.zeros((len(contents) + 3) // 4 * 4, np.uint8)
        self.bytes[:len(contents)] = np.frombuffer(contents, np.uint8)
        self.words = self.bytes.view(np.uint32)
        self.accesses = None

    def contents(self):
        return self.bytes[:self.size].tobytes()


class DeviceMemory:
    """Buffers far from one another. `races`: a set that lines on races go to; None looks for none."""

    def __init__(self, races=None):
        self.buffers, self.races, self._next = [], races, _START

    def add(self, contents):
        buffer = Buffer(self._next, contents)
        self.buffers.append(buffer)
        self._next += (len(contents) + 2 * _GAP) // _GAP * _GAP
        if self.races is not None:
            buffer.accesses = Accesses(len(buffer.words))
        return buffer

    def holding(self, first, last, instruction):
        """The buffer with the bytes from address `first` up to `last`."""
        for buffer in self.buffers:
            if buffer.address <= first and last <= buffer.address + buffer.size:
                return buffer
        raise Fault(f"{instruction.text} reads or writes outside of every buffer, from {self._place(first)}")

    def _place(self, address):
        for buffer in self.buffers:
            if buffer.address - _GAP // 2 <= address < buffer.address + buffer.size + _GAP // 2:
                return f"byte {address - buffer.address} of a buffer of {buffer.size}"
        return hex(address)

    def note(self, wave, buffer, words, instruction, writes):
        """The access to the races' books."""
        if (buffer.accesses.write if writes else buffer.accesses.read)(wave, words):
            self.races.add(f"device memory, {instruction.text}")


class LocalMemory:
    """A group's. Starts as NaNs of a kind that no kernel makes."""

    def __init__(self, size, races=None):
        self.size, self.races = size, races
        self.words = np.full(size // 4 + 1, 0x7fc0dead, np.uint32)
        self.accesses = Accesses(len(self.words)) if races is not None else None

    def note(self, wave, words, instruction, writes):
        if (self.accesses.write if writes else self.accesses.read)(wave, words):
            self.races.add(f"local memory, {instruction.text}")


# Hints to caches, which are not modelled.
_CACHE_MODIFIERS = {"glc", "slc", "dlc", "sc0", "sc1", "nt", "scope", "th"}


def _check_modifiers(instruction, *allowed):
    for name in instruction.modifiers:
        if name not in _CACHE_MODIFIERS and name not in allowed:
            raise UnknownInstruction(f"modifier {name} of {instruction.text}")


def _offset(instruction, name="offset"):
    return int(instruction.modifiers.get(name, "0"), 0)


def _width(kind):
    """Bytes of b32, u16, i8 …"""
    return int(kind[1:]) // 8


def _scalar_load(instruction, kind):
    _check_modifiers(instruction, "offset")
    words = _width(kind) // 4
    target, base = parse(instruction.operands[0]), scalar(parse(instruction.operands[1]), 2)
    more, offset = scalar(parse(instruction.operands[2])), _offset(instruction)
    if target.kind != "s":
        raise UnknownInstruction(instruction.text)

    def execute(wave):
        address = base(wave) + more(wave) + offset
        buffer = wave.memory.holding(address, address + 4 * words, instruction)
        first = (address - buffer.address) // 4
        if buffer.accesses:
            wave.memory.note(wave, buffer, np.arange(first, first + words), instruction, False)
        wave.scalars[target.number:target.number + words] = buffer.words[first:first + words].tolist()
    return execute


def _addresses(address, base, offset, wave_size):
    """A function from a wave to the addresses of the lanes that are on."""
    if base.kind == "none":
        read = lanes(address, "q", wave_size)
        return lambda wave: wave.chosen(read(wave)).astype(np.int64) + offset
    low, high = lanes(address, "u", wave_size), scalar(base, 2)
    return lambda wave: wave.chosen(low(wave)).astype(np.int64) + (high(wave) + offset)


def _extended(values, kind):
    if kind[0] != "i":
        return values
    return values.astype(np.int8 if kind == "i8" else np.int16).astype(np.int32).view(np.uint32)


def _global_access(instruction, writes, kind, wave_size):
    _check_modifiers(instruction, "offset")
    size = _width(kind)
    data, address = (1, 0) if writes else (0, 1)
    register = parse(instruction.operands[data])
    addresses = _addresses(parse(instruction.operands[address]), parse(instruction.operands[2]), _offset(instruction),
                           wave_size)
    if register.kind != "v":
        raise UnknownInstruction(instruction.text)

    def load(wave, buffer, places):
        if size < 4:
            parts = [buffer.bytes[places + n].astype(np.uint32) << np.uint32(8 * n) for n in range(size)]
            wave.write_chosen(register.number, _extended(sum(parts), kind))
        elif (places & 3).any():  # a load may begin at any byte
            for word in range(size // 4):
                parts = [buffer.bytes[places + 4 * word + n].astype(np.uint32) << np.uint32(8 * n) for n in range(4)]
                wave.write_chosen(register.number + word, sum(parts))
        else:
            for word in range(size // 4):
                wave.write_chosen(register.number + word, buffer.words[(places >> 2) + word])

    def store(wave, buffer, places):
        if size < 4:
            values = wave.chosen(wave.vectors[register.number])
            for n in range(size):
                buffer.bytes[places + n] = (values >> np.uint32(8 * n)).astype(np.uint8)
            return
        if (places & 3).any():
            raise UnknownInstruction(f"{instruction.text} at an address that is no multiple of 4")
        for word in range(size // 4):
            buffer.words[(places >> 2) + word] = wave.chosen(wave.vectors[register.number + word])

    def execute(wave):
        if not wave.any_lane():
            return
        reached = addresses(wave)
        buffer = wave.memory.holding(int(reached.min()), int(reached.max()) + size, instruction)
        places = reached - buffer.address
        if buffer.accesses:
            # Of a word that two bytes lie in both count.
            for word in range(max(size // 4, 1)):
                wave.memory.note(wave, buffer, (places >> 2) + word, instruction, writes)
        (store if writes else load)(wave, buffer, places)
    return execute


def _local_access(instruction, writes, apart, kind, wave_size):
    """ds_load and ds_store; `apart` with two places, each with an offset of its own in units of its width."""
    size = _width(kind)
    if size < 4:
        return None
    words = size // 4
    unit = size * (64 if "stride64" in apart else 1)
    _check_modifiers(instruction, *(("offset0", "offset1") if apart else ("offset",)))
    offsets = [unit * _offset(instruction, "offset0"), unit * _offset(instruction, "offset1")] if apart else \
        [_offset(instruction)]
    address = lanes(parse(instruction.operands[0 if writes else 1]), "u", wave_size)
    registers = [parse(text).number for text in instruction.operands[1:]] if writes else \
        [parse(instruction.operands[0]).number + n * words for n in range(len(offsets))]

    def places(wave, offset):
        reached = wave.chosen(address(wave)).astype(np.int64) + offset
        if reached.max() + size > wave.local.size or (reached & 3).any():
            raise Fault(f"{instruction.text} reaches byte {int(reached.max())} of {wave.local.size} of local memory")
        if wave.local.accesses:
            for word in range(words):
                wave.local.note(wave, (reached >> 2) + word, instruction, writes)
        return reached >> 2

    def execute(wave):
        if not wave.any_lane():
            return
        found = []
        for register, offset in zip(registers, offsets):
            first = places(wave, offset)
            for word in range(words):
                if writes:
                    wave.local.words[first + word] = wave.chosen(wave.vectors[register + word])
                else:
                    found.append((register + word, wave.local.words[first + word]))
        for register, values in found:  # the address may lie where the first result goes
            wave.write_chosen(register, values)
    return execute


def decode(instruction, wave_size):
    """What an instruction that reaches memory does to a wave, or None."""
    name = common_name(instruction.mnemonic)
    if match := re.fullmatch(r"s_load_(b\d+)", name):
        return _scalar_load(instruction, match[1])
    if match := re.fullmatch(r"global_(load|store)_([bui]\d+)", name):
        return _global_access(instruction, match[1] == "store", match[2], wave_size)
    if match := re.fullmatch(r"ds_(load|store)(_2addr(?:_stride64)?)?_([bui]\d+)", name):
        return _local_access(instruction, match[1] == "store", match[2] or "", match[3], wave_size)
    return None
