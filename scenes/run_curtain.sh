#!/usr/bin/env bash
# Sets up a Debian 12 or 13 machine (as root, or with sudo), builds the program, runs the curtain without and with the filter,
# and draws both. Leaves out/curtain: report.json, the frames for ParaView and Blender, side_by_side.png.
# FRAMES=N runs fewer or more frames than the scene's 180, at least 31: the picture is of frame 30.
set -euo pipefail
cd "$(dirname "$0")/.."

picture_frame=30
frames=${FRAMES:-180}
[[ "$frames" =~ ^[0-9]+$ && "$frames" -gt "$picture_frame" ]] \
  || { echo "error: FRAMES=$frames: expected a whole number above $picture_frame" >&2; exit 2; }

cmake/debian_packages.sh
cmake --preset program >/dev/null
cmake --build --preset program
program=build/program/apsl

"$program" run scenes/curtain_unfiltered.json --frames "$frames" --out out/curtain_unfiltered
"$program" run scenes/curtain.json --frames "$frames" --out out/curtain
scenes/pictures/side_by_side.py out/curtain_unfiltered out/curtain --frame "$picture_frame" --out out/curtain/side_by_side.png
echo
echo "picture, filter off above and on below:  out/curtain/side_by_side.png"
echo "every frame's figures:                   out/curtain/report.json"
