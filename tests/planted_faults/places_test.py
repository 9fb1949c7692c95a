#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Every planted fault still has its place: the text that it changes stands once in the file that it names."""
import unittest
from pathlib import Path

from faults import FAULTS

ROOT = Path(__file__).resolve().parents[2]


class Places(unittest.TestCase):
    def test_every_fault_has_one(self):
        self.assertGreater(len(FAULTS), 10)
        for fault in FAULTS:
            with self.subTest(fault=fault.what):
                self.assertEqual((ROOT / fault.file).read_text(encoding="utf-8").count(fault.old), 1)


if __name__ == "__main__":
    unittest.main()
