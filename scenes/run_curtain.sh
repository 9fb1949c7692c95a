#!/usr/bin/env bash
# Sets up a Debian 12 machine, builds the program, runs the curtain with and without the filter, and draws it.
# Leaves out/curtain: report.json, the frames, and pictures.
set -euo pipefail
cd "$(dirname "$0")/.."

cmake/debian_packages.sh
cmake --preset dev -DAPSL_BUILD_TESTS=OFF >/dev/null
cmake --build --preset dev --target apsl_program
program=build/dev/scenes/apsl

"$program" run scenes/curtain_unfiltered.json --out out/curtain_unfiltered
"$program" run scenes/curtain.json --out out/curtain
/usr/bin/python3 scenes/pictures/side_by_side.py out/curtain_unfiltered out/curtain --frame 60 --out out/curtain/side_by_side.png
echo "picture: out/curtain/side_by_side.png   report: out/curtain/report.json"
