#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The figures that docs/accuracy.md states, held on the program's own scenes, on the first OpenCL device.

Usage: acceptance_test.py APSL_PROGRAM PROJECT_FOLDER CASE [unittest's arguments]
CASE is one of the classes below. A case runs its scenes once and then judges reports and frames.
"""
import json
import sys
import unittest

import numpy as np
from acceptance_case import Case, project
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader


def read_surface(folder, number):
    """What a frame left as VTK's poly data."""
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(folder / f"frame_{number:04}.vtp"))
    reader.Update()
    return reader.GetOutput()


def read_frame(folder, number):
    """(positions in m [V, 3], triangles [T, 3]) at the end of a frame."""
    surface = read_surface(folder, number)
    positions = vtk_to_numpy(surface.GetPoints().GetData()).astype(np.float64)
    return positions, vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)


def read_area_changes(folder, number):
    """(A − A⁰) / A⁰ of each triangle at the end of a frame, [T]."""
    return vtk_to_numpy(read_surface(folder, number).GetCellData().GetArray("area_change"))


def areas(positions, triangles):
    """m², [T]."""
    corners = positions[triangles]
    return 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)


class Curtain(Case):
    """scenes/curtain.json against the same scene without the filter."""

    @classmethod
    def run_scenes(cls):
        cls.filtered = cls.run_scene("curtain", "curtain.json", frames_wanted=True)
        cls.unfiltered = cls.run_scene("unfiltered", "curtain_unfiltered.json")

    def test_area_change_is_limited(self):
        summary = self.filtered["summary"]
        self.assertEqual(self.filtered["backend"], "opencl")
        self.assertEqual(len(self.filtered["frames"]), 180)
        self.assertEqual(summary["status"], "ok")
        self.assertLessEqual(summary["max_area_change"], 0.10)
        self.assertLessEqual(summary["mean_max_area_change"], 0.05)
        self.assertLessEqual(summary["iterations_per_solve"], 4.0)

    def test_without_the_filter_it_is_not(self):
        self.assertEqual(len(self.unfiltered["frames"]), 180)
        self.assertGreater(self.unfiltered["summary"]["max_area_change"], 0.5)

    def test_both_scenes_differ_in_the_filter_alone(self):
        scenes = [json.loads((project / "scenes" / name).read_text())
                  for name in ("curtain.json", "curtain_unfiltered.json")]
        del scenes[0]["strain_limiting"]
        self.assertEqual(*scenes)

    def test_pinned_vertices_do_not_move_by_one_bit(self):
        pinned = json.loads((project / "scenes/curtain.json").read_text())["pins"][0]["vertices"]
        at_rest = np.array([[-0.5, 0.0, -0.5], [0.5, 0.0, -0.5]])  # m, the corners of the grid in row 0
        for number in range(180):
            positions, _ = read_frame(self.folder("curtain"), number)
            self.assertEqual(positions[pinned].tobytes(), at_rest.tobytes(), f"frame {number}")


class StretchCeiling(Case):
    """A ceiling of 1.1, on the curtain and on a smaller one whose pin draws a corner far out and lets it come back."""

    CEILING = ("--set", 'strain_limiting={"stretch_ceiling": 1.1}')
    # Around a circle of 0.1 m, within half a second: 0.2 m further than there is cloth.
    DRAWN = [{"vertices": [0]}, {"vertices": [32], "motion": {
        "rotate": {"axis": [0, 1, 0], "degrees_per_second": 720, "center": [0.6, 0, -0.5]}, "stop": 0.5}}]

    @classmethod
    def run_scenes(cls):
        cls.curtain = cls.run_scene("ceiling", "curtain.json", *cls.CEILING, "--frames", "60")
        cls.ball = cls.run_scene("ball", "sphere_drape.json", *cls.CEILING, "--set", "mesh.grid.vertices=[33, 33]",
                                 "--frames", "60")
        cls.drawn = cls.run_scene("drawn", "curtain.json", *cls.CEILING, "--frames", "60",
                                  "--set", "mesh.grid.vertices=[33, 33]", "--set", f"pins={json.dumps(cls.DRAWN)}")

    def test_areas_edges_and_stretch_are_held_at_once(self):
        frames = self.curtain["frames"][10:]
        self.assertTrue(all(frame["status"] == "ok" for frame in frames))
        self.assertLessEqual(max(frame["max_area_change"] for frame in frames), 0.02)
        self.assertLessEqual(max(frame["max_edge_stretch"] for frame in frames), 1.12)
        self.assertLessEqual(max(frame["max_principal_stretch"] for frame in frames), 1.125)

    def test_contact_is_kept_in_the_call(self):
        # Behind the call a ball would draw edges to 1.27 times their length, in every frame.
        frames = self.ball["frames"]
        self.assertLessEqual(max(frame["max_edge_stretch"] for frame in frames), 1.13)
        self.assertLessEqual(max(frame["max_area_change"] for frame in frames), 0.05)
        self.assertLessEqual(frames[-1]["max_area_change"], 0.01)
        self.assertLessEqual(max(frame["energy"]["total"] for frame in frames), self.ball["start_energy"]["total"] + 0.01)

    def test_what_a_pin_drew_far_out_comes_back(self):
        frames = self.drawn["frames"]
        self.assertGreater(max(frame["max_principal_stretch"] for frame in frames), 1.5)
        self.assertLessEqual(frames[-1]["max_principal_stretch"], 1.12)
        self.assertLessEqual(frames[-1]["max_area_change"], 0.01)


class PushedCurtain(Case):
    """A ball that moves through a curtain, all of it on the device."""

    @classmethod
    def run_scenes(cls):
        cls.report = cls.run_scene("pushed", "pushed_curtain.json")

    def test_areas_and_edges_are_held_in_contact(self):
        frames = self.report["frames"]
        self.assertTrue(all(frame["status"] == "ok" for frame in frames))
        self.assertLessEqual(max(frame["max_edge_stretch"] for frame in frames), 1.15)
        self.assertLessEqual(sorted(frame["max_area_change"] for frame in frames)[-len(frames) // 20], 0.02)
        self.assertLessEqual(max(frame["max_area_change"] for frame in frames), 0.1)

    def test_energy_rises_only_while_the_ball_pushes(self):
        total = [self.report["start_energy"]["total"], *(frame["energy"]["total"] for frame in self.report["frames"])]
        first_touch = next(n for n in range(72, len(total)) if total[n] > total[n - 1] + 1e-3)
        self.assertGreater(first_touch, 100)  # the ball starts to move in frame 72, 0.8 m away
        self.assertLess(max(total[:first_touch]), 0.01)
        self.assertGreater(max(total[first_touch:]), min(total[:first_touch]) + 0.1)


class PaperFigures(Case):
    """The paper's 96.3 % to 1.94 % (Fig. 1) and 4.77 % in the stand-alone mode (Fig. 6)."""

    @classmethod
    def run_scenes(cls):
        cls.figure_1 = cls.run_scene("figure_1", "paper_fig1.json")
        cls.figure_1_unfiltered = cls.run_scene("unfiltered", "paper_fig1.json", "--set", "strain_limiting=null")
        cls.figure_6 = cls.run_scene("figure_6", "paper_fig6.json")

    def test_figure_1(self):
        self.assertEqual(self.figure_1["summary"]["status"], "ok")
        self.assertLessEqual(self.figure_1["summary"]["max_area_change"], 0.0194)
        self.assertNotIn("strain_limiting", self.figure_1_unfiltered["stages"])
        self.assertGreaterEqual(self.figure_1_unfiltered["summary"]["max_area_change"], 0.9)

    def test_figure_6(self):
        self.assertEqual(self.figure_6["stages"], ["stand_alone"])
        self.assertEqual(self.figure_6["summary"]["status"], "ok")
        self.assertLessEqual(self.figure_6["summary"]["max_area_change"], 0.0477)


class Backends(Case):
    """OpenCL in 32-bit floats against the reference in double precision, 60 frames of the curtain."""

    # The motion is chaotic: after some 20 frames the two are different motions of the same cloth. Summaries are then
    # compared by their ratio; the greatest value of one triangle in one frame is allowed more than the means.
    RATIOS = {"max_area_change": 1.25, "mean_max_area_change": 1.05, "rms_area_change": 1.05,
              "iterations_per_solve": 1.05}

    @classmethod
    def run_scenes(cls):
        cls.opencl = cls.run_scene("opencl", "curtain.json", "--frames", "60", frames_wanted=True)
        cls.reference = cls.run_scene("reference", "curtain.json", "--frames", "60", "--backend", "reference",
                                      frames_wanted=True)

    def test_areas_agree_triangle_by_triangle_over_the_first_10_frames(self):
        self.assertEqual((self.opencl["backend"], self.reference["backend"]), ("opencl", "reference"))
        rest_area = 0.5 / 64**2  # m², every triangle of the grid
        for number in range(10):
            computed, expected = (areas(*read_frame(self.folder(name), number)) for name in ("opencl", "reference"))
            self.assertEqual(len(computed), 8192)
            self.assertLessEqual(abs(computed - expected).max() / rest_area, 0.002, f"frame {number}")

    def test_summaries_are_alike(self):
        for field, ratio in self.RATIOS.items():
            with self.subTest(field=field):
                computed, expected = self.opencl["summary"][field], self.reference["summary"][field]
                self.assertLessEqual(max(computed, expected), ratio * min(computed, expected))


class Repeated(Case):
    """Two runs on one device: the same bytes, for both ways to divide a call."""

    @classmethod
    def run_scenes(cls):
        for execution in ("many_groups", "one_group"):
            for run in ("first", "second"):
                cls.run_scene(f"{execution}_{run}", "curtain.json", "--frames", "40", "--set",
                              f"strain_limiting.execution={execution}", frames_wanted=True)

    def test_same_bytes(self):
        for execution in ("many_groups", "one_group"):
            first, second = self.folder(f"{execution}_first"), self.folder(f"{execution}_second")
            names = sorted(path.name for path in first.iterdir() if path.suffix in (".vtp", ".pc2"))
            self.assertEqual(len(names), 41)
            for name in names:
                self.assertEqual((first / name).read_bytes(), (second / name).read_bytes(), f"{execution}, {name}")


class Garments(Case):
    """Real garments with stiff and with soft springs: the library's defaults, and the defaults by Chebyshev."""

    MESHES = project.parent / "shared" / "meshes"
    PINS = {"skirt": 4.575, "tshirt": 1.079}  # y of the top 3 cm, m, in the file's own place
    FIRST_FRAMES = 10  # for settling
    FRAMES = 120
    LIMITS = {50: 0.02, 5: 0.05}  # greatest area change by N/m
    OTHER_LIMITS = {}  # of limiters that do not keep to these
    LIMITERS = {"none": None, "defaults": {}, "chebyshev": {"solver": "chebyshev"}}
    FRAMES_WANTED = False

    @classmethod
    def run_scenes(cls):
        if not cls.MESHES.is_dir():
            raise unittest.SkipTest(f"{cls.MESHES} is not there: garments passed over")
        cls.reports = {(mesh, stiffness, limiter): cls.run_garment(mesh, stiffness, limiter)
                       for mesh in cls.PINS for stiffness in cls.LIMITS for limiter in cls.LIMITERS}

    @classmethod
    def run_garment(cls, mesh, stiffness, limiter):
        name = f"{mesh}_{stiffness}_{limiter}"
        scene = {"mesh": {"file": str(cls.MESHES / f"{mesh}.obj"), "height": 1.0}, "density": 0.2,
                 "frames": cls.FRAMES, "pins": [{"box": {"min": [-9, cls.PINS[mesh], -9]}}],
                 "integrator": {"implicit_springs": {"stretch_stiffness": stiffness, "bend_stiffness": 0.05,
                                                     "damping": 0.5}}}
        path = cls.folder(f"{name}.scene.json")
        path.write_text(json.dumps(scene))
        return cls.run_scene(name, path, "--set", f"strain_limiting={json.dumps(cls.LIMITERS[limiter])}",
                             frames_wanted=cls.FRAMES_WANTED and limiter != "none")

    def judge(self, judge):
        """`judge(mesh, stiffness, limiter)` of every limited run, each by itself."""
        for mesh, stiffness, limiter in self.reports:
            if limiter != "none":
                with self.subTest(mesh=mesh, stiffness=stiffness, limiter=limiter):
                    judge(mesh, stiffness, limiter)

    def limit(self, stiffness, limiter):
        return self.OTHER_LIMITS.get(limiter, self.LIMITS)[stiffness]

    def greatest(self, mesh, stiffness, limiter):
        return max(frame["max_area_change"] for frame in
                   self.reports[mesh, stiffness, limiter]["frames"][self.FIRST_FRAMES:])

    def test_areas_are_held(self):
        self.judge(lambda mesh, stiffness, limiter: self.assertLessEqual(
            self.greatest(mesh, stiffness, limiter), self.limit(stiffness, limiter)))

    def test_never_above_the_unlimited_run(self):
        def judge(mesh, stiffness, limiter):
            unlimited = self.reports[mesh, stiffness, "none"]["frames"]
            for number, frame in enumerate(self.reports[mesh, stiffness, limiter]["frames"]):
                self.assertLessEqual(frame["max_area_change"], unlimited[number]["max_area_change"], number)

        self.judge(judge)

    def test_no_frame_is_worsened_or_diverged(self):
        self.judge(lambda *run: self.assertLessEqual(
            {frame["status"] for frame in self.reports[run]["frames"]}, {"ok", "not_converged"}))


class GarmentWithSlivers(Garments):
    """A garment with triangles of a thousandth of the median's area, and vertices as light: the filter raises masses."""

    PINS = {"dress": 1.6993}
    LIMITS = {50: 0.10, 5: 0.25}  # of triangles above the first percentile of rest area
    # Chaotic: 0.20 to 0.36 for stiffnesses next to 5. A smaller α takes a longer polynomial, which forgives a bound that
    # does not hold even less.
    LIMITERS = {**Garments.LIMITERS, "chebyshev_103": {"solver": "chebyshev", "regularization": 1.03}}
    OTHER_LIMITS = {"chebyshev": {50: 0.10, 5: 0.50}, "chebyshev_103": {50: 0.20, 5: 0.50}}
    FRAMES_WANTED = True

    def test_areas_are_held(self):
        def judge(mesh, stiffness, limiter):
            folder = self.folder(f"{mesh}_{stiffness}_{limiter}")
            rest = areas(*read_frame(folder, 0)) / (1.0 + read_area_changes(folder, 0))
            well_shaped = rest >= np.percentile(rest, 1)
            greatest = max(np.abs(read_area_changes(folder, number)[well_shaped]).max()
                           for number in range(self.FIRST_FRAMES, self.FRAMES))
            self.assertLessEqual(greatest, self.limit(stiffness, limiter))

        self.judge(judge)

    def test_the_report_tells_of_it(self):
        for (_, _, limiter), report in self.reports.items():
            light = report["light_vertices"]
            self.assertGreater(light["count"], 0)
            self.assertEqual(any(frame["raised_vertices"] > 0 for frame in report["frames"]), limiter != "none")


class CornerTriangles(Case):
    """Curtains that hang by two corners, on uniform diagonals: there a pinned corner may lie in one triangle alone. Its
    area is held; that its edges are not, the report says."""

    CORNERS = ([0, 32], [1056, 1088], [0, 1056], [32, 1088])
    ALONE = {0: 0, 1088: 2047}  # pinned vertex: its only triangle

    @classmethod
    def run_scenes(cls):
        cls.reports = {}
        for pins in cls.CORNERS:
            cls.reports[tuple(pins)] = cls.run_scene(
                f"corners_{pins[0]}_{pins[1]}", "curtain.json", "--set", "mesh.grid.vertices=[33,33]", "--set",
                'mesh.grid.diagonals="uniform"', "--set", f'pins=[{{"vertices":{pins}}}]', "--set", "strain_limiting={}")

    def test_areas_are_held(self):
        for pins, report in self.reports.items():
            with self.subTest(pins=pins):
                self.assertLessEqual(report["summary"]["max_area_change"], 0.02)

    def test_the_report_names_what_gives_way(self):
        for pins, report in self.reports.items():
            named = report["over_stretched"]
            with self.subTest(pins=pins):
                self.assertGreater(report["summary"]["max_edge_stretch"], 1.5)
                self.assertEqual(named["triangles"][0]["edge_stretch"], report["summary"]["max_edge_stretch"])
                self.assertEqual(len(named["triangles"]), min(named["count"], 10))
                why = {entry["triangle"]: entry["why"] for entry in named["triangles"]}
                for pin, triangle in self.ALONE.items():
                    if pin in pins:
                        self.assertTrue(why[triangle].startswith(
                            f"hangs by pinned vertex {pin}, in no other triangle"), why[triangle])

    def test_nothing_is_named_where_edges_hold(self):
        report = self.run_scene("twist", "twist.json", "--frames", "30")
        self.assertLess(report["summary"]["max_edge_stretch"], 1.5)
        self.assertEqual(report["over_stretched"], {"above": 1.5, "count": 0, "triangles": []})


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]], defaultTest=sys.argv[3])
