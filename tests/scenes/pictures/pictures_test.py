#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""render.py and side_by_side.py on made-up cloth: what the pixels say, and what goes wrong in one line."""

import json
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np
from PIL import Image

from waving_cloth import grid_triangles, write_frame, write_index, write_sequence

PICTURES = Path(__file__).resolve().parents[3] / "scenes" / "pictures"
RENDER = PICTURES / "render.py"
SIDE_BY_SIDE = PICTURES / "side_by_side.py"
# Seen from the front the sheet's middle is the picture's, its left half at rest and its right half stretched.
FRONT = ("--azimuth", "0", "--elevation", "0")


def run(script, *arguments, **environment):
    return subprocess.run([sys.executable, str(script), *map(str, arguments)], capture_output=True, text=True,
                          timeout=100, env={**os.environ, **environment})


def pixels(path):
    with Image.open(path) as picture:
        return np.asarray(picture.convert("RGB")).astype(int)


def share_of(image, wanted):
    return float(np.mean(wanted(image[..., 0], image[..., 1], image[..., 2])))


def is_red(r, g, b):
    return (r > 90) & (g < 0.05 * r) & (b < 0.05 * r)


def is_white(r, g, b):
    """White or, where shaded, grey: no hue at all; brighter than the background, which is bluish."""
    return (r > 100) & (abs(r - g) <= 2) & (abs(r - b) <= 2)


class Folder(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def picture(self, *arguments):
        """The only picture that render.py draws with these arguments."""
        done = run(RENDER, *arguments, "--out", self.folder / "out")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stderr, "")
        (path,) = (self.folder / "out").iterdir()
        return pixels(path)

    def assert_one_line_error(self, done, *parts):
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
        for part in parts:
            self.assertIn(part, done.stderr)


class Render(Folder):
    def test_every_frame_becomes_a_picture_of_the_asked_size(self):
        cloth = write_sequence(self.folder / "run", frames=4)
        done = run(RENDER, cloth, "--every", "2", "--size", "900x400")
        self.assertEqual(done.returncode, 0, done.stderr)
        drawn = sorted((cloth / "pictures").iterdir())
        self.assertEqual([path.name for path in drawn], ["frame_0000.png", "frame_0002.png"])
        self.assertEqual({pixels(path).shape for path in drawn}, {(400, 900, 3)})
        self.assertNotEqual(drawn[0].read_bytes(), drawn[1].read_bytes())

    def test_rest_is_white_and_the_stated_change_pure_red(self):
        cloth = write_sequence(self.folder / "run", frames=1, stretched=0.10)
        image = self.picture(cloth, "--views", "absolute", "--red", "0.10", "--size", "600x480", *FRONT)
        left, right = image[100:350, 160:290], image[100:350, 310:440]
        self.assertGreater(share_of(left, is_white), 0.95)
        self.assertGreater(share_of(right, is_red), 0.95)

    def test_stretch_is_coloured_from_1_to_the_stated_stretch(self):
        cloth = write_sequence(self.folder / "run", frames=1, stretched=0.10)
        image = self.picture(cloth, "--views", "stretch", "--red-stretch", "1.1", "--size", "600x480", *FRONT)
        left, right = image[100:350, 160:290], image[100:350, 310:440]
        self.assertGreater(share_of(left, is_red), 0.95)
        self.assertGreater(share_of(right, is_white), 0.95)

    def test_half_the_stated_change_is_half_way_to_red(self):
        cloth = write_sequence(self.folder / "run", frames=1, stretched=0.05)
        image = self.picture(cloth, "--views", "absolute", "--red", "0.10", "--size", "600x480", *FRONT)
        r, g, b = image[100:350, 310:440].reshape(-1, 3).T
        self.assertAlmostEqual(float(np.median(g / r)), 0.5, delta=0.03)
        self.assertAlmostEqual(float(np.median(b / r)), 0.5, delta=0.03)

    def test_normalised_makes_the_greatest_change_red_however_small(self):
        cloth = write_sequence(self.folder / "run", frames=1, stretched=0.002)
        size = ("--size", "600x480")
        image = self.picture(cloth, "--normalised", *size, *FRONT)
        self.assertGreater(share_of(image[100:350, 310:440], is_red), 0.95)
        self.assertGreater(share_of(image[100:350, 160:290], is_white), 0.95)

    def test_a_cloth_at_rest_is_white_in_both_colourings(self):
        cloth = write_sequence(self.folder / "run", frames=1, stretched=0.0)
        image = self.picture(cloth, "--views", "absolute,normalised", "--size", "1000x400", *FRONT)
        self.assertEqual(share_of(image[60:300], is_red), 0.0)
        self.assertGreater(share_of(image[100:250, 200:300], is_white), 0.95)
        self.assertGreater(share_of(image[100:250, 700:800], is_white), 0.95)

    def test_plain_cloth_is_neither_white_nor_red_and_folds_are_shaded(self):
        cloth = write_sequence(self.folder / "run", frames=1)
        image = self.picture(cloth, "--views", "cloth", "--size", "600x480", *FRONT)[250:350, 160:440]
        self.assertEqual(share_of(image, is_red), 0.0)
        self.assertEqual(share_of(image, is_white), 0.0)
        # The waves run along y: brightness varies along a row, by far more than rounding.
        self.assertGreater(np.ptp(image.sum(axis=2).mean(axis=0)), 40)

    def test_the_camera_stands_still_and_holds_the_whole_motion(self):
        folder = self.folder / "run"
        folder.mkdir()
        triangles = grid_triangles(3, 3)
        sheet = np.array([(c - 1, 1 - r, 0) for r in range(3) for c in range(3)], float)
        for frame, shift in enumerate((0.0, 2.0, 4.0)):
            write_frame(folder / f"cloth_{frame:04}.vtp", sheet + [shift, 0, 0], triangles, np.zeros(8))
        write_index(folder, [f"cloth_{frame:04}.vtp" for frame in range(3)])
        done = run(RENDER, folder, "--views", "absolute", "--size", "600x300", *FRONT)
        self.assertEqual(done.returncode, 0, done.stderr)
        middles = []
        for frame in range(3):
            image = pixels(folder / "pictures" / f"frame_{frame:04}.png")[30:220]
            columns = np.nonzero(is_white(image[..., 0], image[..., 1], image[..., 2]).any(axis=0))[0]
            self.assertGreater(columns.min(), 0)
            self.assertLess(columns.max(), 599)
            middles.append(columns.mean())
        self.assertAlmostEqual(middles[1], 300, delta=4)
        self.assertAlmostEqual(middles[1] - middles[0], middles[2] - middles[1], delta=4)
        self.assertGreater(middles[1] - middles[0], 100)

    def test_colliders_of_the_reported_scene_are_drawn(self):
        scene = self.folder / "scene.json"
        scene.write_text(json.dumps({"colliders": [{"sphere": {"center": [0, 0, 0.3], "radius": 0.2}}]}))
        bare = self.picture(write_sequence(self.folder / "a", frames=1), "--views", "absolute", *FRONT)
        done = run(RENDER, write_sequence(self.folder / "b", frames=1, scene=scene), "--views", "absolute", *FRONT)
        self.assertEqual(done.returncode, 0, done.stderr)
        with_sphere = pixels(self.folder / "b" / "pictures" / "frame_0000.png")
        middle = (slice(240, 280), slice(700, 730))
        self.assertGreater(share_of(bare[middle], is_red), 0.95)
        self.assertEqual(share_of(with_sphere[middle], is_red), 0.0)

    def test_colliders_that_move_are_drawn_where_they_are(self):
        # The second frame is that of 1 s.
        middle = (slice(240, 280), slice(700, 730))
        for name, motion, drawn in (
                ("away", {"translate": {"velocity": [2, 0, 0]}}, False),
                ("stopped", {"translate": {"velocity": [2, 0, 0]}, "stop": 0}, True),
                ("turned", {"rotate": {"axis": [0, 1, 0], "degrees_per_second": 90, "center": [0.5, 0, 0]}}, False),
                ("about_itself", {"rotate": {"axis": [0, 1, 0], "degrees_per_second": 90}}, True)):
            with self.subTest(motion=name):
                scene = self.folder / f"{name}.json"
                sphere = {"center": [0, 0, 0.3], "radius": 0.2}
                scene.write_text(json.dumps({"colliders": [{"sphere": sphere, "motion": motion}]}))
                done = run(RENDER, write_sequence(self.folder / name, frames=2, scene=scene), "--views", "absolute",
                           *FRONT)
                self.assertEqual(done.returncode, 0, done.stderr)
                red = share_of(pixels(self.folder / name / "pictures" / "frame_0001.png")[middle], is_red)
                self.assertEqual(red > 0.95, not drawn)
                self.assertEqual(red == 0.0, drawn)

    def test_a_cloth_that_broke_down_is_still_drawn(self):
        folder = self.folder / "run"
        folder.mkdir()
        triangles = grid_triangles(3, 3)
        sheet = np.array([(c - 1, 1 - r, 0) for r in range(3) for c in range(3)], float)
        sheet[8] = np.nan
        change = np.zeros(8)
        change[-1] = np.nan
        write_frame(folder / "cloth_0000.vtp", sheet, triangles, change)
        write_index(folder, ["cloth_0000.vtp"])
        image = self.picture(folder, "--views", "absolute,normalised", *FRONT)
        self.assertGreater(share_of(image[60:450], is_white), 0.05)


class RenderErrors(Folder):
    def test_missing_folder_and_missing_index(self):
        self.assert_one_line_error(run(RENDER, self.folder / "absent"), "absent", "no such folder")
        self.assert_one_line_error(run(RENDER, self.folder), "cloth.pvd", "apsl run")

    def test_frames_that_are_not_there(self):
        cloth = write_sequence(self.folder / "run", frames=2)
        self.assert_one_line_error(run(RENDER, cloth, "--frames", "7"), "no frame 7", "0 to 1")
        (cloth / "cloth_0001.vtp").unlink()
        self.assert_one_line_error(run(RENDER, cloth), "cloth_0001.vtp", "no such file")
        write_index(cloth, [])
        self.assert_one_line_error(run(RENDER, cloth), "cloth.pvd", "no frame")
        (cloth / "cloth.pvd").write_text("<VTKFile")
        self.assert_one_line_error(run(RENDER, cloth), "cloth.pvd", "not a ParaView collection")

    def test_broken_frame(self):
        cloth = write_sequence(self.folder / "run", frames=1)
        whole = (cloth / "cloth_0000.vtp").read_bytes()
        (cloth / "cloth_0000.vtp").write_bytes(whole[: len(whole) // 2])
        self.assert_one_line_error(run(RENDER, cloth), "cloth_0000.vtp")
        (cloth / "cloth_0000.vtp").write_text("nothing of the kind")
        self.assert_one_line_error(run(RENDER, cloth), "cloth_0000.vtp")

    def test_frame_without_area_change(self):
        cloth = write_sequence(self.folder / "run", frames=1)
        write_frame(cloth / "cloth_0000.vtp", np.eye(3), [(0, 1, 2)], None)
        self.assert_one_line_error(run(RENDER, cloth), "cloth_0000.vtp", "area_change")
        write_frame(cloth / "cloth_0000.vtp", np.eye(3), [(0, 1, 2)], [0.0])
        self.assert_one_line_error(run(RENDER, cloth, "--views", "stretch"), "cloth_0000.vtp", "principal_stretch")

    def test_wrong_arguments(self):
        cloth = write_sequence(self.folder / "run", frames=1)
        for arguments in (["--red-stretch", "1"], ["--red", "0"], ["--red", "nan"], ["--size", "10x10"], ["--every", "0"], ["--frames", "x"],
                          ["--views", "side"], ["--elevation", "90"], ["--zoom", "0"], ["--bogus"], ["--red", "much"]):
            with self.subTest(arguments=arguments):
                self.assert_one_line_error(run(RENDER, cloth, *arguments), arguments[0])
        self.assert_one_line_error(run(RENDER), "DIR")

    def test_unwritable_output(self):
        cloth = write_sequence(self.folder / "run", frames=1)
        (self.folder / "file").write_text("in the way")
        self.assert_one_line_error(run(RENDER, cloth, "--out", self.folder / "file"), "cannot be written")

    def test_missing_packages_are_named(self):
        cloth = write_sequence(self.folder / "run", frames=1)
        for module, package in (("vtkmodules", "python3-vtk9"), ("PIL", "python3-pil")):
            broken = self.folder / module
            broken.mkdir()
            (broken / f"{module}.py").write_text(f"raise ImportError('No module named {module}')")
            done = run(RENDER, cloth, PYTHONPATH=str(broken))
            self.assert_one_line_error(done, f"apt-get install {package}")


class SideBySide(Folder):
    def test_off_above_on_with_one_camera_within_the_size(self):
        off = write_sequence(self.folder / "off", stretched=0.5)
        on = write_sequence(self.folder / "on", stretched=0.001)
        out = self.folder / "both.png"
        done = run(SIDE_BY_SIDE, off, on, "--frame", "1", "--out", out, *FRONT)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertLessEqual(out.stat().st_size, 300_000)
        image = pixels(out)
        self.assertEqual(image.shape, (912, 1200, 3))
        absolute, normalised = slice(620, 680), slice(1020, 1080)
        upper, lower = slice(120, 300), slice(576, 756)
        self.assertGreater(share_of(image[upper, absolute], is_red), 0.95)
        self.assertEqual(share_of(image[lower, absolute], is_red), 0.0)
        self.assertGreater(share_of(image[upper, normalised], is_red), 0.95)
        self.assertGreater(share_of(image[lower, normalised], is_red), 0.95)

    def test_palette_when_the_file_would_be_too_big(self):
        off, on = (write_sequence(self.folder / name) for name in ("off", "on"))
        out = self.folder / "both.png"
        done = run(SIDE_BY_SIDE, off, on, "--frame", "last", "--out", out, "--max-bytes", "1", *FRONT)
        self.assertEqual(done.returncode, 0, done.stderr)
        with Image.open(out) as picture:
            self.assertEqual(picture.mode, "P")

    def test_errors(self):
        off, on = write_sequence(self.folder / "off", frames=3), write_sequence(self.folder / "on", frames=2)
        out = self.folder / "both.png"
        self.assert_one_line_error(run(SIDE_BY_SIDE, off, on, "--frame", "2", "--out", out), "no frame 2")
        self.assert_one_line_error(run(SIDE_BY_SIDE, off, self.folder / "x", "--frame", "2", "--out", out), "no such")
        self.assert_one_line_error(run(SIDE_BY_SIDE, off, on, "--frame", "1", "--out", "a.jpg"), ".png")
        self.assertFalse(out.exists())


if __name__ == "__main__":
    unittest.main()
