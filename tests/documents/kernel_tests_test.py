#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Every kernel has a test case in tests/kernels that carries its name as a tag: apsl_kernel_tests "[NAME]" runs them.

Usage: kernel_tests_test.py PROJECT
"""
import re
import sys
import unittest
from pathlib import Path

project = Path(sys.argv[1])


def names(pattern, files):
    return {name for file in files for name in re.findall(pattern, file.read_text(), re.MULTILINE)}


class KernelTests(unittest.TestCase):
    def test_every_kernel_is_a_tag(self):
        kernels = names(r"^APSLK_KERNEL void (\w+)\(", (project / "kernels").glob("*.cl"))
        self.assertIn("cg_update", kernels)
        self.assertEqual(kernels - names(r"\[(\w+)\]", (project / "tests/kernels").glob("*.cpp")), set())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
