# SPDX-License-Identifier: MIT
"""The snippet of docs/embedding/python.md and the example, run as they stand.

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

    def test_the_snippet_leaves_what_it_says(self):
        page = (PROJECT / "docs/embedding/python.md").read_text()
        snippets = re.findall(r"^```python\n(.*?)^```", page, re.DOTALL | re.MULTILINE)
        self.assertEqual(len(snippets), 1, "snippets in docs/embedding/python.md")
        (self.folder / "snippet.py").write_text(snippets[0])
        said = re.fullmatch(r"greatest area change (\S+) before, (\S+) after: ok\n", self.run_python("snippet.py"))
        self.assertTrue(said)
        self.assertLess(float(said[2]), 0.1 * float(said[1]))

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
