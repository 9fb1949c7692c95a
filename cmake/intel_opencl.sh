#!/usr/bin/env bash
# Installs Intel's OpenCL for CPUs into build/intel-opencl, a virtual environment: a second compiler and runtime to test
# on. From PyPI, Debian has none. Some 230 MB to fetch.
set -euo pipefail
cd "$(dirname "$0")/.."

folder=build/intel-opencl
version=2026.2.0
[[ -e "$folder/lib/libintelocl.so" && "$(cat "$folder/version" 2>/dev/null)" == "$version" ]] && exit 0
rm -rf "$folder"
/usr/bin/python3 -m venv "$folder"
# The second package holds the mathematics library that the first links.
"$folder/bin/pip" install --quiet --disable-pip-version-check "intel-opencl-rt==$version"
"$folder/bin/pip" install --quiet --disable-pip-version-check --no-deps "intel-cmplr-lib-rt==$version"
echo "$version" > "$folder/version"
