#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""The ABI check catches what it is for: a library with the functions of apsl.h passes, one with a planted change fails."""
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

import c_abi

HEADER = (c_abi.HEADERS / "apsl" / "apsl.h").read_text()


class PlantedChanges(unittest.TestCase):
    def changes(self, header):
        """The check's report for a library that defines what this version of apsl.h declares, with empty bodies."""
        with tempfile.TemporaryDirectory() as folder:
            headers = Path(folder) / "apsl"
            headers.mkdir()
            for name in ("export.hpp", "version.hpp"):
                (headers / name).write_text((c_abi.HEADERS / "apsl" / name).read_text())
            (headers / "apsl.h").write_text(header)
            functions = re.findall(r"^APSL_API\s+(.*?\));", header, re.S | re.M)
            source = Path(folder) / "bodies.c"
            source.write_text("#include <apsl/apsl.h>\n" + "".join(f"{f} {{ __builtin_trap(); }}\n" for f in functions))
            library = Path(folder) / "libapsl.so"
            soname = re.search(r"soname='([^']*)'", c_abi.BASELINE.read_text()).group(1)
            subprocess.run(["cc", "-g", "-w", "-fPIC", "-shared", f"-Wl,-soname,{soname}", "-DCL_TARGET_OPENCL_VERSION=120",
                            f"-I{folder}", str(source), "-o", str(library)], check=True)
            return c_abi.report(library, folder)

    def planted(self, pattern, replacement):
        header, count = re.subn(pattern, replacement, HEADER, count=1, flags=re.S)
        self.assertEqual(count, 1, f"{pattern} is not in apsl.h")
        return self.changes(header)

    def test_unchanged(self):
        self.assertEqual(self.changes(HEADER), "")

    def test_removed_function(self):
        report = self.planted(r"APSL_API size_t apsl_limiter_scratch_bytes\(.*?\);", "")
        self.assertIn("1 Removed", report)
        self.assertIn("apsl_limiter_scratch_bytes", report)

    def test_added_function(self):
        self.assertIn("apsl_added", self.planted(r"(APSL_API size_t)", r"APSL_API int apsl_added(void);\n\1"))

    def test_reordered_fields_of_one_type(self):
        report = self.planted(r"float max_area_change;(.*?)float rms_area_change;",
                              r"float rms_area_change;\1float max_area_change;")
        self.assertIn("apsl_stats", report)

    def test_reordered_fields_of_two_types(self):
        report = self.planted(r"cl_mem buffer;(.*?)size_t offset;", r"size_t offset;\1cl_mem buffer;")
        self.assertIn("apsl_buffer_view", report)

    def test_wider_field(self):
        self.assertIn("apsl_options", self.planted("uint32_t work_group_size", "uint64_t work_group_size"))

    def test_changed_parameter(self):
        self.assertIn("apsl_topology_create", self.planted("size_t vertex_count", "uint32_t vertex_count"))

    def test_renumbered_enumerators(self):
        self.assertIn("APSL_ERROR_OPENCL", self.planted("APSL_ERROR_OPENCL = 3", "APSL_ERROR_OPENCL = 30"))
        self.assertIn("APSL_MATRIX_PRINTED", self.planted("APSL_MATRIX_PRINTED = 1", "APSL_MATRIX_PRINTED = 2"))


if __name__ == "__main__":
    unittest.main()
