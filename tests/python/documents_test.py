# SPDX-License-Identifier: MIT
"""The snippets of docs/embedding/python.md and the example, run as they stand.

Usage: documents_test.py PROJECT_FOLDER
"""
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np
from matplotlib import image

PROJECT = Path(sys.argv[1]).resolve()


class Documents(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def run_python(self, *arguments):
        result = subprocess.run([sys.executable, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True,
                                timeout=100, env={**os.environ, "MPLBACKEND": "Agg"})
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        return result.stdout

    def test_the_snippets_leave_what_they_say(self):
        page = (PROJECT / "docs/embedding/python.md").read_text()
        snippets = re.findall(r"^```python\n(.*?)^```", page, re.DOTALL | re.MULTILINE)
        self.assertEqual(len(snippets), 2, "snippets in docs/embedding/python.md")
        said = []
        for place, snippet in enumerate(snippets):
            (self.folder / f"snippet{place}.py").write_text(snippet)
            said.append(self.run_python(f"snippet{place}.py"))
        copied = re.fullmatch(r"greatest area change (\S+) before, (\S+) after: ok\n", said[0])
        self.assertTrue(copied, said[0])
        self.assertLess(float(copied[2]), 0.1 * float(copied[1]))
        on_device = re.fullmatch(r"greatest area change (\S+) after: ok\n", said[1])
        self.assertTrue(on_device, said[1])
        self.assertLess(float(on_device[1]), 0.05)

    def test_the_example_draws_both_cloths(self):
        said = self.run_python(PROJECT / "docs/embedding/python_example.py", "cloth.png")
        without, with_filter = map(float, re.search(r"([\d.]+) % without, ([\d.]+) % with", said).groups())
        self.assertGreater(without, 50)
        self.assertLess(with_filter, 0.2 * without)
        pixels = image.imread(self.folder / "cloth.png")[..., :3]
        left, right = (pixels[:, half] for half in (slice(0, 400), slice(400, 800)))
        red = [(np.abs(half - [1, 0, 0]) < 0.2).all(axis=2).mean() for half in (left, right)]
        self.assertGreater(red[0], 10 * red[1])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
