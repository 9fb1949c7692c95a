# SPDX-License-Identifier: MIT
"""The caller's OpenCL objects: of pyopencl, where the caller has imported that, or handles as integers."""

from __future__ import annotations

import operator
import sys
from typing import Any, Protocol, Tuple, Union

from ._records import Error


class OpenClObject(Protocol):
    """A Context, Device, CommandQueue, Event or Buffer of pyopencl."""

    @property
    def int_ptr(self) -> int: ...


class OpenClArray(Protocol):
    """A pyopencl.array.Array."""

    @property
    def base_data(self) -> Any: ...
    @property
    def offset(self) -> int: ...
    @property
    def shape(self) -> Any: ...
    @property
    def strides(self) -> Any: ...
    @property
    def dtype(self) -> Any: ...


Handle = Union[OpenClObject, int]
DeviceArray = Union[OpenClArray, Handle, Tuple[Handle, int]]  # a pair: a buffer, and an offset in bytes

# The classes whose objects will do, and what a line says was expected.
_kinds = {"Context": ("Context", "a pyopencl.Context"), "Device": ("Device", "a pyopencl.Device"),
          "CommandQueue": ("CommandQueue", "a pyopencl.CommandQueue"), "Event": ("Event", "a pyopencl.Event"),
          "Buffer": ("MemoryObjectHolder", "a pyopencl Buffer or Array")}


def _class(module: str, name: str) -> Any:
    """() where the caller has not imported the module: nothing is an instance of that."""
    return getattr(sys.modules.get(module), name, ())


def refuse(argument: str, got: str, expected: str) -> Error:
    return Error(f"{argument}: got {got}, expected {expected}")


def address(given: object, argument: str, kind: str) -> int:
    """Of an object's handle. An integer is taken at its word."""
    class_name, expected = _kinds[kind]
    if isinstance(given, _class("pyopencl", class_name)):
        return int(given.int_ptr)
    got = type(given).__name__
    if not isinstance(given, bool):
        try:
            number = operator.index(given)  # type: ignore[arg-type]
        except TypeError:
            pass
        else:
            if 0 < number < 2**64:
                return number
            got = str(number)
    raise refuse(argument, got, f"{expected}, or a handle as an integer")


def addresses(events: Any) -> list[int]:
    """Of the argument wait_for."""
    if events is None:
        return []
    if not isinstance(events, (list, tuple)):
        raise refuse("wait_for", type(events).__name__, "a list of events")
    return [address(event, f"wait_for[{number}]", "Event") for number, event in enumerate(events)]


def is_array(given: object) -> bool:
    return isinstance(given, _class("pyopencl.array", "Array"))


def events_of(given: Any) -> list[int]:
    """Of what is queued for an Array."""
    return [int(event.int_ptr) for event in given.events] if is_array(given) else []


def place(given: Any, argument: str, dtype: str, shape: tuple[int, ...], strides: tuple[int, ...]) -> tuple[int, int]:
    """A buffer and an offset in bytes. An Array must be of that type, shape (a vector may have more components) and
    strides in bytes; of a Buffer the library checks the size."""
    if is_array(given):
        if given.dtype != dtype:
            raise refuse(argument, f"dtype {given.dtype}", dtype)
        got = tuple(given.shape)
        if len(got) != len(shape) or got[0] != shape[0] or got[1:] < shape[1:]:
            raise refuse(argument, f"shape {got}", str(shape))
        if tuple(given.strides) != strides:
            raise refuse(argument, f"strides {tuple(given.strides)} bytes", f"{strides} as the options say")
        return address(given.base_data, argument, "Buffer"), int(given.offset)
    if not isinstance(given, tuple):
        return address(given, argument, "Buffer"), 0
    if len(given) != 2 or isinstance(given[1], bool) or not hasattr(given[1], "__index__") or given[1] < 0:
        raise refuse(argument, str(given), "a buffer and an offset in bytes")
    return address(given[0], argument, "Buffer"), operator.index(given[1])


def event(handle: int) -> Any:
    """A pyopencl.Event, which releases it, or the handle."""
    event_class = _class("pyopencl", "Event")
    return event_class.from_int_ptr(handle, retain=False) if event_class else handle
