# SPDX-License-Identifier: MIT
"""Reads the mesh sequence that `apsl run --out DIR` leaves: DIR/cloth.pvd, one VTP a frame, DIR/report.json."""

import json
import re
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from pathlib import Path

from picture_error import PictureError, needs_package

try:
    import numpy as np
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkObject
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
except ImportError as missing:
    needs_package("python3-vtk9", missing)


@dataclass(frozen=True)
class Frame:
    number: int  # the number in the file's name, or the place in the index where names carry none
    path: Path
    time: float  # s, at the end of the frame; NaN where the index gives none


@dataclass
class Cloth:
    surface: object  # vtkPolyData with the cell data `area_change`
    area_change: "np.ndarray"  # |A − A⁰| / A⁰, [T]; not finite where the simulation broke down

    @property
    def points(self):
        """Vertex positions, m, [V, 3]."""
        return vtk_to_numpy(self.surface.GetPoints().GetData()).astype(np.float64)

    @property
    def max_area_change(self):
        """Greatest area change over triangles; infinite as soon as one is not finite."""
        return float(self.area_change.max()) if np.isfinite(self.area_change).all() else float("inf")


def read_index(folder):
    """Frames of the sequence in `folder`, in order of time."""
    index = Path(folder) / "cloth.pvd"
    if not Path(folder).is_dir():
        raise PictureError(f"{folder}: no such folder; expected one that `apsl run --out DIR` wrote")
    if not index.is_file():
        raise PictureError(f"{index}: no such file; expected the frames that `apsl run --out DIR` writes")
    try:
        entries = list(ElementTree.parse(index).iter("DataSet"))
        entries.sort(key=lambda entry: float(entry.get("timestep", "nan")))
        paths = [index.parent / entry.attrib["file"] for entry in entries]
        times = [float(entry.get("timestep", "nan")) for entry in entries]
    except (ElementTree.ParseError, KeyError, ValueError) as error:
        raise PictureError(f"{index}: not a ParaView collection ({error})") from None
    if not paths:
        raise PictureError(f"{index}: holds no frame")
    numbers = [re.search(r"(\d+)$", path.stem) for path in paths]
    if all(numbers) and len({int(number[1]) for number in numbers}) == len(paths):
        return [Frame(int(number[1]), path, time) for number, path, time in zip(numbers, paths, times)]
    return [Frame(place, path, time) for place, (path, time) in enumerate(zip(paths, times))]


def choose_frames(frames, wanted, every=1):
    """`wanted`: "all", "last", or numbers and ranges such as "0,30,60-90"; then each `every`-th of those."""
    if wanted == "last":
        return frames[-1:]
    if wanted == "all":
        return frames[::every]
    numbers = []
    for part in wanted.split(","):
        match = re.fullmatch(r"\s*(\d+)(?:-(\d+))?\s*", part)
        if not match:
            raise PictureError(f"--frames {wanted}: expected all, last, or numbers and ranges such as 0,30,60-90")
        first, last = int(match[1]), int(match[2] or match[1])
        if last < first:
            raise PictureError(f"--frames {wanted}: the range {part.strip()} runs backwards")
        numbers.append((first, last))
    chosen = [frame for frame in frames if any(first <= frame.number <= last for first, last in numbers)]
    for first, last in numbers:
        if not any(first <= frame.number <= last for frame in frames):
            raise PictureError(f"--frames {wanted}: no frame {first}; the sequence holds {frames[0].number} to "
                               f"{frames[-1].number}")
    return chosen[::every]


def read_cloth(frame, with_stretch=False):
    """The cloth of one frame, checked: points, triangles and the cell data `area_change`; `principal_stretch` too where
    that is asked for."""
    if not frame.path.is_file():
        raise PictureError(f"{frame.path}: no such file, though the index names it")
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(frame.path))
    vtkObject.GlobalWarningDisplayOff()  # VTK's own complaints run over many lines
    reader.Update()
    vtkObject.GlobalWarningDisplayOn()
    surface = reader.GetOutput()
    triangles = surface.GetNumberOfPolys()
    if surface.GetNumberOfPoints() == 0 or triangles == 0 or surface.GetNumberOfCells() != triangles:
        raise PictureError(f"{frame.path}: not a whole VTP file of points and triangles")
    corners = vtk_to_numpy(surface.GetPolys().GetConnectivityArray())
    if corners.min() < 0 or corners.max() >= surface.GetNumberOfPoints():
        raise PictureError(f"{frame.path}: a triangle names a vertex outside 0 to {surface.GetNumberOfPoints() - 1}")
    for name in ("area_change", "principal_stretch") if with_stretch else ("area_change",):
        values = surface.GetCellData().GetArray(name)
        if values is None or values.GetNumberOfTuples() != triangles:
            raise PictureError(f"{frame.path}: no cell data `{name}` for each triangle, which `apsl run` writes")
    values = surface.GetCellData().GetArray("area_change")
    return Cloth(surface, vtk_to_numpy(values).astype(np.float64))


def read_colliders(folder, scene=None):
    """The `colliders` of the scene that the report names, or of `scene`; none where neither can be found."""
    if scene is None:
        try:
            scene = json.loads((Path(folder) / "report.json").read_text())["scene"]
        except (OSError, ValueError, KeyError, TypeError):
            return []
        if not Path(scene).is_file():
            return []
    try:
        return json.loads(Path(scene).read_text()).get("colliders", [])
    except OSError as error:
        raise PictureError(f"{scene}: cannot be read ({error.strerror})") from None
    except (ValueError, AttributeError) as error:
        raise PictureError(f"{scene}: not a scene file ({error})") from None
