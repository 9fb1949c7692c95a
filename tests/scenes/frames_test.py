#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The frames that `apsl run --out` writes, read back by VTK itself.

Usage: frames_test.py APSL_PROGRAM PROJECT_FOLDER
"""
import json
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

program, project = Path(sys.argv[1]), Path(sys.argv[2])
FRAMES = 4


class Frames(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = Path(cls.temporary.name)
        subprocess.run([program, "run", project / "scenes/curtain.json", "--frames", str(FRAMES), "--backend",
                        "reference", "--out", cls.folder], check=True, capture_output=True)
        cls.report = json.loads((cls.folder / "report.json").read_text())

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def read(self, name):
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(str(self.folder / name))
        reader.Update()
        return reader.GetOutput()

    def test_index_names_every_frame_at_its_time(self):
        entries = list(ElementTree.parse(self.folder / "cloth.pvd").iter("DataSet"))
        self.assertEqual([entry.get("file") for entry in entries], [f"frame_{k:04}.vtp" for k in range(FRAMES)])
        times = [float(entry.get("timestep")) for entry in entries]
        np.testing.assert_allclose(times, [(k + 1) * 0.016666667 for k in range(FRAMES)])

    def test_greatest_and_rms_area_change_of_the_cells_are_the_report_s(self):
        for k in range(FRAMES):
            surface = self.read(f"frame_{k:04}.vtp")
            changes = vtk_to_numpy(surface.GetCellData().GetArray("area_change"))
            self.assertEqual(len(changes), self.report["triangles"])
            frame = self.report["frames"][k]
            self.assertAlmostEqual(changes.max(), frame["max_area_change"], delta=1e-6)
            self.assertAlmostEqual(np.sqrt((changes.astype(float) ** 2).mean()), frame["rms_area_change"], delta=1e-6)

    def test_greatest_principal_stretch_of_the_cells_is_the_report_s(self):
        for k in range(FRAMES):
            stretches = vtk_to_numpy(self.read(f"frame_{k:04}.vtp").GetCellData().GetArray("principal_stretch"))
            self.assertEqual(len(stretches), self.report["triangles"])
            self.assertAlmostEqual(stretches.max(), self.report["frames"][k]["max_principal_stretch"], delta=1e-6)

    def test_points_are_the_point_cache_s_and_move_by_their_velocities(self):
        cache = (self.folder / "cloth.pc2").read_bytes()
        samples = np.frombuffer(cache, np.float32, offset=32).reshape(FRAMES, self.report["vertices"], 3)
        for k in range(FRAMES):
            surface = self.read(f"frame_{k:04}.vtp")
            points = vtk_to_numpy(surface.GetPoints().GetData())
            self.assertEqual(points.dtype, np.float64)  # the cache's format has 32 bits alone
            np.testing.assert_array_equal(points.astype(np.float32), samples[k])
            if k > 0:
                velocities = vtk_to_numpy(surface.GetPointData().GetArray("velocity"))
                np.testing.assert_allclose(points - samples[k - 1], velocities * 0.016666667, atol=1e-6)

    def test_triangles_cover_the_cloth(self):
        surface = self.read("frame_0000.vtp")
        corners = vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)
        points = vtk_to_numpy(surface.GetPoints().GetData()).astype(float)
        a, b, c = (points[corners[:, k]] for k in range(3))
        area = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()
        self.assertAlmostEqual(area, 1.0, delta=0.01)

    def test_pinned_vertices_do_not_move_by_one_bit(self):
        for k in range(FRAMES):
            points = vtk_to_numpy(self.read(f"frame_{k:04}.vtp").GetPoints().GetData())
            np.testing.assert_array_equal(points[[0, 64]], [[-0.5, 0, -0.5], [0.5, 0, -0.5]])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
