#!/usr/bin/env bash
# A hundred thousand frames (28 minutes of cloth) of the curtain on a grid of 33×33: does energy, area change or memory
# drift? Some five minutes on two cores. Leaves docs/stability/long_run.json and its chart.
#   tests/stability/long_run.sh [FRAMES]
set -euo pipefail
cd "$(dirname "$0")/../.."

cmake/debian_packages.sh --tests
cmake --preset ci >/dev/null
cmake --build --preset ci --target apsl_long_run
mkdir -p docs/stability
build/ci/tests/stability/apsl_long_run scenes/curtain.json "${1:-100000}" docs/stability/long_run.json \
  'mesh.grid.vertices=[33, 33]' 'pins=[{"vertices": [0, 32]}]'
tests/stability/long_run_chart.py docs/stability/long_run.json --out docs/stability/long_run.png
