#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What `apsl run --out` leaves for Blender, byte by byte, and for ParaView, by VTK's reader: areas recomputed from the
files are those of the array that colours them. Blender itself: blender_test.py.

Usage: viewer_files_test.py APSL_PROGRAM PROJECT_FOLDER
"""
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersVerdict import vtkCellSizeFilter
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

from run_output import FRAMES, ROUNDING, areas, read_obj, read_pc2, run_curtain

program, project = Path(sys.argv[1]), Path(sys.argv[2])


class Files(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = Path(temporary.name)
        cls.report = run_curtain(program, project, cls.folder)
        cls.rest, cls.triangles = read_obj(cls.folder / "cloth.obj")
        cls.rest_areas = areas(cls.rest, cls.triangles)

    def surface(self, frame):
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(str(self.folder / f"frame_{frame:04}.vtp"))
        reader.Update()
        return reader.GetOutput()

    def change_in(self, frame):
        return vtk_to_numpy(self.surface(frame).GetCellData().GetArray("area_change"))


class Blender(Files):
    def test_mesh_is_the_cloth_at_rest(self):
        self.assertEqual(self.rest.shape, (self.report["vertices"], 3))
        self.assertEqual(self.triangles.shape, (self.report["triangles"], 3))
        self.assertEqual((self.triangles.min(), self.triangles.max()), (0, len(self.rest) - 1))
        np.testing.assert_allclose(self.rest_areas, 0.5 / 64**2)

    def test_cache_has_a_sample_for_each_frame_from_0_on(self):
        start, rate, samples = read_pc2(self.folder / "cloth.pc2")
        self.assertEqual((start, rate, samples.shape), (0, 1, (FRAMES, len(self.rest), 3)))

    def test_mesh_and_cache_give_the_area_change_of_every_triangle(self):
        _, _, samples = read_pc2(self.folder / "cloth.pc2")
        for frame, positions in enumerate(samples):
            change = np.abs(areas(positions, self.triangles) - self.rest_areas) / self.rest_areas
            np.testing.assert_allclose(change, self.change_in(frame), atol=ROUNDING)
            self.assertAlmostEqual(change.max(), self.report["frames"][frame]["max_area_change"], delta=ROUNDING)
        self.assertGreater(change.max(), 0.01)  # or all of this would hold for a cloth that never moved


class ParaView(Files):
    def test_index_leads_to_every_frame(self):
        files = [entry.get("file") for entry in ElementTree.parse(self.folder / "cloth.pvd").iter("DataSet")]
        self.assertEqual(len(files), FRAMES)
        for file in files:
            self.assertTrue((self.folder / file).is_file(), file)

    def test_area_change_colours_the_faces_unless_another_is_chosen(self):
        data = self.surface(FRAMES - 1).GetCellData()
        self.assertEqual(data.GetScalars().GetName(), "area_change")
        self.assertEqual(data.GetScalars().GetNumberOfTuples(), len(self.triangles))

    def test_area_change_is_that_of_vtks_own_areas(self):
        for frame in range(FRAMES):
            measure = vtkCellSizeFilter()
            measure.SetInputData(self.surface(frame))
            measure.Update()
            area = vtk_to_numpy(measure.GetOutput().GetCellData().GetArray("Area"))
            np.testing.assert_allclose(np.abs(area - self.rest_areas) / self.rest_areas, self.change_in(frame),
                                       atol=ROUNDING)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
