# SPDX-License-Identifier: MIT
"""The kernels of a folder of sources, compiled for a target as the gate does, and recorded launches of them."""
import sys
from functools import lru_cache
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import amd_compiler  # noqa: E402
import variants  # noqa: E402
from assembly import kernels_of  # noqa: E402
from launch import Schedule, run  # noqa: E402
from memory import DeviceMemory  # noqa: E402
from recording import RecordedBuffer, contents  # noqa: E402


class Compiled:
    """Files are compiled when a kernel of theirs is first launched."""

    def __init__(self, clang, device_libraries, kernels, target):
        self.clang, self.device_libraries, self.kernels, self.target = clang, device_libraries, kernels, target
        self._files = {}
        self._names = lru_cache(maxsize=None)(lambda source: variants.defines_read_by(kernels / source))

    def defines_of(self, launch):
        """The part of the program's defines that the kernel's file reads."""
        return tuple((name, launch.defines[name]) for name in self._names(launch.source))

    def kernel(self, launch):
        """Raises amd_compiler.CompileError."""
        key = launch.source, self.defines_of(launch)
        if key not in self._files:
            assembly, _ = amd_compiler.compile_source(self.clang, self.device_libraries, self.kernels / launch.source,
                                                      key[1], self.target)
            self._files[key] = kernels_of(assembly)
        return self._files[key][launch.kernel]

    def all_kernels(self):
        """Those of the files compiled so far."""
        return [kernel for file in self._files.values() for kernel in file.values()]

    def execute(self, launch, held, schedule=Schedule(), races=None):
        """Executes a recorded launch. `held`: {number of a buffer: bytes}, what differs from the recording; what the
        launch leaves goes there too. `races`: a set for lines on races. Wave instructions executed.

        Raises amd_compiler.CompileError, UnknownInstruction and Fault.
        """
        kernel = self.kernel(launch)
        memory, buffers, arguments = DeviceMemory(races), {}, []
        for argument in launch.arguments:
            if not isinstance(argument, RecordedBuffer):
                arguments.append(argument)
                continue
            if argument.number not in buffers:
                buffers[argument.number] = memory.add(held.get(argument.number) or contents(argument.before))
            arguments.append(buffers[argument.number].address.to_bytes(8, "little"))
        executed = run(kernel, self.target, memory, arguments, launch.grid, schedule)
        held.update({number: buffer.contents() for number, buffer in buffers.items()})
        return executed
