#!/usr/bin/env bash
# Sets up a Debian 12 or 13 machine, builds everything with warnings as errors, and runs all tests: on pocl, on a checker, on a
# second OpenCL implementation, under sanitizers; and the fuzzers. Fails without an OpenCL device.
set -euo pipefail
cd "$(dirname "$0")/.."

cmake/debian_packages.sh --tests
git ls-files '*.cpp' '*.hpp' '*.h' '*.cl' | xargs -r clang-format-19 --dry-run --Werror
skipped=()
dpkg-query -W oclgrind >/dev/null 2>&1 || skipped+=("SKIPPED: the tests on Oclgrind: this release of Debian does not have it")
cmake/intel_opencl.sh || skipped+=("SKIPPED: the tests on Intel's OpenCL: cmake/intel_opencl.sh could not install it")
cmake --preset ci
cmake --build --preset ci
ctest --preset ci -j "$(nproc)"
# The readers of scenes and meshes, each fuzzed for a while with clang's sanitizers.
cmake --preset fuzz
cmake --build --preset fuzz
ctest --preset fuzz -j "$(nproc)"

# The library's host code under the address, leak and undefined-behaviour sanitizers. The whole suite under them is a
# command of its own: cmake --preset asan && cmake --build --preset asan && ctest --preset asan
cmake --preset asan
cmake --build --preset asan-library
ctest --preset asan-library -j "$(nproc)"

# Limiters in several threads under the thread sanitizer.
cmake --preset tsan
cmake --build --preset tsan
ctest --preset tsan -j "$(nproc)"
echo "not run here: every work-group size, 10,000 random cases, all AMD targets: ctest --preset thorough -j $(nproc)"
[[ ${#skipped[@]} -eq 0 ]] || printf '%s\n' "${skipped[@]}" >&2
