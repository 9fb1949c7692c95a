# SPDX-License-Identifier: MIT
"""A made-up sequence in the form that `apsl run --out DIR` writes: a waving sheet, stretched over its right half."""

import json
import math
from pathlib import Path

from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter
import numpy as np


def grid_triangles(columns, rows):
    """Alternating diagonals, [T, 3]; vertex (column c, row r) has index r * columns + c."""
    triangles = []
    for r in range(rows - 1):
        for c in range(columns - 1):
            a, b = r * columns + c, r * columns + c + 1
            d, e = a + columns, b + columns
            triangles += [(a, d, b), (b, d, e)] if (r + c) % 2 == 0 else [(a, d, e), (a, e, b)]
    return triangles


def write_frame(path, points, triangles, area_change, stretch=None):
    positions = vtkPoints()
    positions.SetData(numpy_to_vtk(np.ascontiguousarray(points, np.float32), deep=True))
    cells = vtkCellArray()
    for triangle in triangles:
        cells.InsertNextCell(3, triangle)
    surface = vtkPolyData()
    surface.SetPoints(positions)
    surface.SetPolys(cells)
    for name, of_triangles in (("area_change", area_change), ("principal_stretch", stretch)):
        if of_triangles is not None:
            values = numpy_to_vtk(np.ascontiguousarray(of_triangles, np.float32), deep=True)
            values.SetName(name)
            surface.GetCellData().AddArray(values)
    writer = vtkXMLPolyDataWriter()
    writer.SetFileName(str(path))
    writer.SetInputData(surface)
    writer.Write()


def write_index(folder, names):
    entries = "".join(f'<DataSet timestep="{place}" part="0" file="{name}"/>' for place, name in enumerate(names))
    (Path(folder) / "cloth.pvd").write_text(
        f'<?xml version="1.0"?><VTKFile type="Collection" version="0.1"><Collection>{entries}</Collection></VTKFile>')


def write_sequence(folder, frames=3, side=17, stretched=0.25, wave=0.06, scene=None):
    """A sheet in the plane z = 0, 1 m wide. Area change is 0 left of the middle and `stretched` right of it."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    triangles = grid_triangles(side, side)
    names = []
    for frame in range(frames):
        points = np.empty((side * side, 3))
        for r in range(side):
            for c in range(side):
                x, y = c / (side - 1) - 0.5, 0.5 - r / (side - 1)
                points[r * side + c] = (x, y, wave * math.sin(14 * x + 0.2 * frame) * (0.5 - y))
        middles = points[np.array(triangles)].mean(axis=1)
        area_change = np.where(middles[:, 0] < 0.0, 0.0, stretched)
        names.append(f"cloth_{frame:04}.vtp")
        # Stretched left of the middle, where the areas are at rest.
        stretch = np.where(middles[:, 0] < 0.0, 1.0 + stretched, 1.0)
        write_frame(folder / names[-1], points, triangles, area_change, stretch)
    write_index(folder, names)
    report = {"scene": str(scene) if scene else "made_up.json", "frames": [], "summary": {"status": "ok"}}
    (folder / "report.json").write_text(json.dumps(report))
    return folder
