# SPDX-License-Identifier: MIT
"""Operands of instructions: which register or constant, how it is read, and where results go."""
import re
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from assembly import UnknownInstruction

WORD = 0xffffffff
VCC, M0, EXEC = 106, 125, 126  # scalar registers with a name
FIRST_TRAP_REGISTER = 108  # ttmp0

_NAMED = {"vcc": ("s", VCC), "vcc_lo": ("s", VCC), "vcc_hi": ("s", VCC + 1), "exec": ("s", EXEC),
          "exec_lo": ("s", EXEC), "exec_hi": ("s", EXEC + 1), "m0": ("s", M0), "null": ("none", 0), "off": ("none", 0),
          "scc": ("scc", 0)}
# Floats that fit into an instruction: their bits.
_FLOATS = {"0.5": 0x3f000000, "-0.5": 0xbf000000, "1.0": 0x3f800000, "-1.0": 0xbf800000, "2.0": 0x40000000,
           "-2.0": 0xc0000000, "4.0": 0x40800000, "-4.0": 0xc0800000, "0.15915494": 0x3e22f983,
           "0.15915494309189532": 0x3e22f983}


@dataclass(frozen=True)
class Operand:
    kind: str  # v: vector register, s: scalar register, constant, scc, none
    number: int = 0  # of the first register, or the constant
    negated: bool = False
    absolute: bool = False
    sign_extended: bool = False
    part: str = "DWORD"  # of 32 bits: BYTE_0 … WORD_1

    def register(self, offset):
        """The operand `offset` registers on."""
        return Operand(self.kind, self.number + offset, self.negated, self.absolute)


@lru_cache(maxsize=None)
def parse(text, part="DWORD"):
    negated = absolute = sign_extended = False
    whole = text
    if text.startswith("sext("):
        sign_extended, text = True, text[5:-1]
    if re.match(r"-[vs|(]", text):
        negated, text = True, text[1:]
    elif text.startswith("neg("):
        negated, text = True, text[4:-1]
    if text.startswith("|"):
        absolute, text = True, text.strip("|")
    elif text.startswith("abs("):
        absolute, text = True, text[4:-1]
    if text in _NAMED:
        kind, number = _NAMED[text]
    elif register := re.fullmatch(r"(v|s|ttmp)(?:(\d+)|\[(\d+):\d+\])", text):
        kind, number = register[1], int(register[2] or register[3])
        if kind == "ttmp":
            kind, number = "s", FIRST_TRAP_REGISTER + number
    elif text in _FLOATS:
        kind, number = "constant", _FLOATS[text]
    elif re.fullmatch(r"-?(0x[0-9a-fA-F]+|\d+)", text):
        kind, number = "constant", int(text, 0)
    else:
        raise UnknownInstruction(f"operand {whole}")
    return Operand(kind, number, negated, absolute, sign_extended, part)


def scalar(operand, words=1):
    """A function from a wave to the operand's value, an int of 32 or 64 bits."""
    bits = (1 << 32 * words) - 1
    number = operand.number
    if operand.kind == "constant":
        return lambda wave: number & bits
    if operand.kind == "none":
        return lambda wave: 0
    if operand.kind == "scc":
        return lambda wave: wave.scc
    if operand.kind == "v":
        raise UnknownInstruction("a vector register where a scalar one is expected")
    if words == 2:
        return lambda wave: wave.scalars[number] | wave.scalars[number + 1] << 32
    return lambda wave: wave.scalars[number]


def scalar_target(operand, words=1):
    """A function that writes an int, as far as the register holds it."""
    number = operand.number
    if operand.kind == "none":
        return lambda wave, value: None
    if operand.kind != "s":
        raise UnknownInstruction(f"a result that goes to {operand.kind}")
    if number in (EXEC, EXEC + 1):
        def write_exec(wave, value):
            for n in range(words):
                wave.scalars[number + n] = value >> 32 * n & WORD
            wave.take_exec()
        return write_exec

    def write(wave, value):
        wave.scalars[number] = value & WORD
        if words == 2:
            wave.scalars[number + 1] = value >> 32 & WORD
    return write


def lane_mask(operand, wave_size):
    """A function from a wave to one bool a lane."""
    read = scalar(operand, wave_size // 32)
    return lambda wave: wave.lanes_of(read(wave))


def lane_mask_target(operand, wave_size):
    """A function that writes one bool a lane; lanes that are off get 0."""
    write = scalar_target(operand, wave_size // 32)
    return lambda wave, lanes: write(wave, wave.mask_of(lanes))


def _bits(operand):
    number = operand.number
    if operand.part != "DWORD":
        width, place = (16 if operand.part.startswith("WORD") else 8), int(operand.part[-1])
        low = np.uint32((1 << width) - 1)
        signed = np.int16 if width == 16 else np.int8

        def read_part(wave):
            part = (wave.vectors[number] >> np.uint32(width * place)) & low
            return part.astype(signed).astype(np.int32).view(np.uint32) if operand.sign_extended else part
        if operand.kind != "v":
            raise UnknownInstruction("a part of a scalar register")
        return read_part
    if operand.kind == "v":
        return lambda wave: wave.vectors[number]
    if operand.kind == "constant":
        constant = np.array([number & WORD], np.uint32)
        return lambda wave: constant
    read = scalar(operand)
    return lambda wave: np.array([read(wave)], np.uint32)


def _floats(operand):
    bits = _bits(operand)
    if operand.kind == "v" and operand.part == "DWORD":
        number = operand.number
        plain = lambda wave: wave.floats[number]  # noqa: E731
    else:
        plain = lambda wave: bits(wave).view(np.float32)  # noqa: E731
    if operand.absolute and operand.negated:
        return lambda wave: -np.abs(plain(wave))
    if operand.absolute:
        return lambda wave: np.abs(plain(wave))
    if operand.negated:
        return lambda wave: -plain(wave)
    return plain


def _pairs(operand):
    """64 bits from two registers."""
    number = operand.number
    if operand.kind == "v":
        return lambda wave: (wave.vectors[number].astype(np.uint64) |
                             wave.vectors[number + 1].astype(np.uint64) << np.uint64(32))
    read = scalar(operand, 2)
    return lambda wave: np.array([read(wave)], np.uint64)


def lanes(operand, kind, wave_size):
    """A function from a wave to an array, one entry a lane, or a single entry for all. `kind`: f float, u unsigned,
    i signed, b bits that a float's sign may be taken from, q 64 bits, m one bool."""
    if kind == "m":
        return lane_mask(operand, wave_size)
    if kind == "q":
        return _pairs(operand)
    if kind == "f":
        return _floats(operand)
    if kind == "b":
        read = _floats(operand)
        return lambda wave: read(wave).view(np.uint32)
    if operand.negated or operand.absolute:
        raise UnknownInstruction("a sign taken from a whole number")
    bits = _bits(operand)
    return bits if kind == "u" else lambda wave: bits(wave).view(np.int32)
