# SPDX-License-Identifier: MIT
"""A short run of the curtain, and readers of what it leaves that share no line with the writers."""

import json
import struct
import subprocess
from pathlib import Path

import numpy as np

FRAMES = 12
SECONDS_PER_FRAME = 0.016666667  # scenes/curtain.json
# Of an area change: positions are 32-bit, 3e-8 m off where edges are 1/64 m long.
ROUNDING = 2e-5


def run_curtain(program, project, folder):
    """Runs the curtain into `folder` and returns its report."""
    subprocess.run([program, "run", project / "scenes/curtain.json", "--frames", str(FRAMES), "--backend", "reference",
                    "--out", folder], check=True, capture_output=True)
    return json.loads((Path(folder) / "report.json").read_text())


def read_obj(file):
    """Vertices [V, 3] and triangles [T, 3], indices from 0. Anything but v and f lines is an error."""
    lines = [line.split() for line in Path(file).read_text().splitlines()]
    unknown = {line[0] for line in lines} - {"v", "f"}
    if unknown:
        raise ValueError(f"{file}: lines that begin with {unknown}")
    vertices = np.array([line[1:] for line in lines if line[0] == "v"], float)
    return vertices, np.array([line[1:] for line in lines if line[0] == "f"], int) - 1


def read_pc2(file):
    """First frame, frames a sample, and the samples [N, V, 3] of a PC2 point cache."""
    content = Path(file).read_bytes()
    name, version, points, start, rate, samples = struct.unpack_from("<12siiffi", content)
    if (name, version) != (b"POINTCACHE2\0", 1) or len(content) != 32 + 12 * points * samples:
        raise ValueError(f"{file}: {name!r} version {version}, {len(content)} bytes for {samples} samples of {points}")
    return start, rate, np.frombuffer(content, "<f4", offset=32).reshape(samples, points, 3)


def areas(positions, triangles):
    """m², [T]."""
    a, b, c = (positions[triangles[:, k]].astype(float) for k in range(3))
    return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
