# SPDX-License-Identifier: MIT
"""scenes/pictures/blender_import.py inside Blender: motion, area change and colour of every frame. Run by blender.sh.

Usage: blender_test.py APSL_PROGRAM PROJECT_FOLDER
"""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import bpy
import numpy as np

from run_output import FRAMES, ROUNDING, SECONDS_PER_FRAME, areas, read_obj, read_pc2, run_curtain

program, project = Path(sys.argv[1]), Path(sys.argv[2])
script = project / "scenes/pictures/blender_import.py"
sys.path.insert(0, str(script.parent))
import blender_import  # noqa: E402


def shown(cloth, frame):
    """Vertices in world space [V, 3] and the faces' area change [T] as Blender shows them in that frame."""
    bpy.context.scene.frame_set(frame)
    mesh = (evaluated := cloth.evaluated_get(bpy.context.evaluated_depsgraph_get())).data
    points = np.array([evaluated.matrix_world @ vertex.co for vertex in mesh.vertices])
    change = np.empty(len(mesh.polygons), np.float32)
    mesh.attributes["area_change"].data.foreach_get("value", change)
    return points, change


class InBlender(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = Path(temporary.name)
        cls.report = run_curtain(program, project, cls.folder / "run")
        cls.rest, cls.triangles = read_obj(cls.folder / "run/cloth.obj")
        cls.samples = read_pc2(cls.folder / "run/cloth.pc2")[2]

    def setUp(self):
        bpy.ops.wm.read_factory_settings(use_empty=True)

    def check_every_frame(self, cloth):
        rest_areas = areas(self.rest, self.triangles)
        for frame in range(FRAMES):
            points, change = shown(cloth, frame)
            x, y, z = self.samples[frame].T
            np.testing.assert_allclose(points, np.stack([x, -z, y], axis=1), atol=1e-6)  # Blender's z is up
            expected = np.abs(areas(self.samples[frame], self.triangles) - rest_areas) / rest_areas
            np.testing.assert_allclose(change, expected, atol=ROUNDING)
            self.assertAlmostEqual(change.max(), self.report["frames"][frame]["max_area_change"], delta=ROUNDING)

    def test_motion_and_area_change_of_every_frame(self):
        self.check_every_frame(blender_import.import_run(self.folder / "run"))

    def test_time_is_the_run_s(self):
        blender_import.import_run(self.folder / "run")
        scene = bpy.context.scene
        self.assertEqual((scene.frame_start, scene.frame_end), (0, FRAMES - 1))
        self.assertAlmostEqual(scene.render.fps_base / scene.render.fps, SECONDS_PER_FRAME, places=6)

    def test_a_saved_file_needs_no_script(self):
        saved = self.folder / "cloth.blend"
        arguments = ["--background", "--", self.folder / "run", "--save", saved]  # as Blender passes them on
        result = subprocess.run([sys.executable, script, *arguments], capture_output=True, text=True, timeout=100)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        bpy.ops.wm.open_mainfile(filepath=str(saved))
        self.assertEqual([entry.name for entry in bpy.data.objects], ["cloth"])
        self.check_every_frame(bpy.data.objects["cloth"])

    def test_cycles_draws_it_white_to_red(self):
        cloth = blender_import.import_run(self.folder / "run", red=1e-4)
        red = []
        for frame in (0, FRAMES - 1):  # hardly moved, and past the top of so short a scale nearly everywhere
            picture = self.folder / f"frame_{frame}.png"
            blender_import.render(cloth, frame, picture, size=(160, 120), samples=4)
            image = bpy.data.images.load(str(picture))
            pixels = np.array(image.pixels).reshape(120, 160, 4)
            red.append((pixels[..., 0] > 2 * pixels[..., 1:3].max(axis=2)).mean())
        self.assertLess(red[0], 0.01)
        self.assertGreater(red[1], 0.05)

    def test_a_folder_without_a_run_is_refused_in_one_line(self):
        result = subprocess.run([sys.executable, script, self.folder], capture_output=True, text=True, timeout=100)
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stderr, r"^error: .*cloth\.obj: no such file; expected what .* leaves\n$")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
