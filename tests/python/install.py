#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes a fresh virtual environment with apsl installed from its source tree, warnings as errors.

Usage: install.py ENVIRONMENT PROJECT_FOLDER
"""
import subprocess
import sys
from pathlib import Path

environment, project = Path(sys.argv[1]), Path(sys.argv[2])
subprocess.run([sys.executable, "-m", "venv", "--clear", "--system-site-packages", environment], check=True)
pip = [environment / "bin/pip", "install", "--quiet", "--disable-pip-version-check"]
subprocess.run([*pip, "--config-settings=cmake.define.APSL_WARNINGS_AS_ERRORS=ON", project], check=True)
# Debian 12's mypy is too old for keyword arguments by TypedDict.
subprocess.run([*pip, "--upgrade", "mypy>=1.8,<2"], check=True)
