# SPDX-License-Identifier: MIT
"""What recorder.cpp wrote: the launches of a scenario, with the contents of their buffers before and after."""
import re
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path

from launch import Grid


class BadRecording(Exception):
    """No recording, or one that cannot be read; one line."""


@dataclass(frozen=True)
class RecordedBuffer:
    number: int  # the same for every argument that is this buffer
    before: Path
    after: Path


@dataclass
class RecordedLaunch:
    scenario: str
    number: int  # in the scenario, from 0
    kernel: str
    source: str  # file name in kernels/
    defines: dict  # of the program's build
    grid: Grid
    arguments: list = field(default_factory=list)  # a RecordedBuffer, or the bytes of a value

    def __str__(self):
        return f"{self.scenario}#{self.number} {self.kernel}"


@lru_cache(maxsize=512)
def contents(path):
    return path.read_bytes()


_KERNEL = re.compile(r'^#line \d+ "kernels/(\w+\.\w+)"$|^APSLK_KERNEL\b[^;{]*?\bvoid\s+(\w+)\s*\(', re.MULTILINE)


def _sources_of_kernels(program_text):
    """{kernel: the file of kernels/ that it stands in}, of a program put together from several files."""
    sources, file = {}, ""
    for found in _KERNEL.finditer(program_text):
        if found[1]:
            file = found[1]
        else:
            sources[found[2]] = file
    return sources


def _defines(build_options):
    return {name: int(value) for name, value in re.findall(r"-D (\w+)=(\d+)", build_options)}


def launches_of(folder):
    """All launches of a scenario, in order. Raises BadRecording."""
    if not (folder / "index.txt").exists():
        raise BadRecording(f"{folder} holds no recording, expected index.txt; record.py writes one")
    sources, defines, launches = {}, {}, []
    for line in (folder / "index.txt").read_text(encoding="utf-8").splitlines():
        what, *words = line.split(" ")
        if what == "program":
            sources[words[0]] = _sources_of_kernels((folder / f"program_{words[0]}.cl").read_text(encoding="utf-8"))
            defines[words[0]] = _defines(line)
        elif what == "launch":
            number, kernel, program, groups, cloths, size = words
            launches.append(RecordedLaunch(folder.name, int(number), kernel, sources[program][kernel],
                                           defines[program], Grid(int(groups), int(cloths), int(size))))
        elif what == "buffer":
            launches[-1].arguments.append(RecordedBuffer(int(words[0]), folder / words[1], folder / words[2]))
        elif what == "value":
            launches[-1].arguments.append(bytes.fromhex(words[0]))
        else:
            raise BadRecording(f"{folder / 'index.txt'}: {line}")
    return launches
