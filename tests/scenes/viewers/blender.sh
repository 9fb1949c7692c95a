#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs Blender as a Python module below build/ (a download of about 370 MB; Python 3.11, as Debian 12 has) and runs
# its test. Once it is there, CTest runs the test too.
# Usage: blender.sh [APSL_PROGRAM]
set -euo pipefail
cd "$(dirname "$0")/../../.."

cmake/debian_packages.sh --blender
python=build/blender/bin/python
if ! "$python" -c 'import bpy' 2>/dev/null; then
  /usr/bin/python3 -m venv build/blender
  build/blender/bin/pip install --quiet --no-cache-dir 'bpy==4.5.*'
fi
program="${1:-build/program/apsl}"
if [[ ! -x "$program" ]]; then
  cmake --preset program >/dev/null
  cmake --build --preset program
fi
PYTHONDONTWRITEBYTECODE=1 "$python" tests/scenes/viewers/blender_test.py "$program" .
