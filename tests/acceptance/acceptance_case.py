# SPDX-License-Identifier: MIT
"""What the acceptance tests share: the program, and a test case that runs scenes once and then judges."""
import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

program, project = (Path(argument).resolve() for argument in sys.argv[1:3])


class Case(unittest.TestCase):
    """Runs scenes into a folder that goes with the case."""

    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.temporary.cleanup)
        cls.run_scenes()

    @classmethod
    def folder(cls, name):
        return Path(cls.temporary.name) / name

    @classmethod
    def run_scene(cls, name, scene, *arguments, frames_wanted=False):
        """The report of one run, which must end well."""
        report = cls.folder(f"{name}.json")
        command = [program, "run", project / "scenes" / scene, "--report", report, *arguments]
        if frames_wanted:
            command += ["--out", cls.folder(name)]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode != 0:
            raise AssertionError(f"{' '.join(map(str, command))}: exit code {done.returncode}: {done.stderr}")
        return json.loads(report.read_text())
