#!/usr/bin/env bash
# Sets up a Debian 12 machine, builds everything with warnings as errors, and runs all tests. Fails without an OpenCL
# device.
set -euo pipefail
cd "$(dirname "$0")/.."

cmake/debian_packages.sh --tests
git ls-files '*.cpp' '*.hpp' '*.h' '*.cl' | xargs -r clang-format-19 --dry-run --Werror
cmake --preset ci
cmake --build --preset ci
ctest --preset ci -j "$(nproc)"
# The readers of scenes and meshes, each fuzzed for a while with clang's sanitizers.
cmake --preset fuzz
cmake --build --preset fuzz
ctest --preset fuzz -j "$(nproc)"
