#!/usr/bin/env bash
# Packs what bench/gpu.sh runs into one folder, to be carried to a machine with a GPU: the tests of kernels and filter,
# the benchmarks, apsl, bench/gpu.sh itself, and every shared library that they need beyond glibc, OpenCL's loader among
# them.
#     bench/gpu_bundle.sh BUILD BUNDLE        BUILD: a build tree with the benchmarks, such as build/ci
# The machine with the GPU needs a glibc at least as new as this one's. BUNDLE must be new or empty.
set -euo pipefail

[[ $# -eq 2 ]] || { echo "usage: bench/gpu_bundle.sh BUILD BUNDLE" >&2; exit 2; }
build="$1" bundle="$2"
source="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"

targets=(apsl_program apsl_kernel_tests apsl_filter_tests apsl_kernel_bench traced_cloth)
programs=(apsl tests/kernels/apsl_kernel_tests tests/filter/apsl_filter_tests bench/kernels/apsl_kernel_bench
  bench/embedded/traced_cloth)
for program in "${programs[@]}"; do
  [[ -x "$build/$program" ]] || {
    echo "error: $build/$program is not there; build it: cmake --build $build --target ${targets[*]}" \
      "(with APSL_BUILD_BENCHMARKS, which the presets ci and bench have on)" >&2
    exit 2
  }
done
[[ ! -e "$bundle" || (-d "$bundle" && -z "$(ls -A "$bundle")") ]] \
  || { echo "error: $bundle is there already, expected a new or an empty folder" >&2; exit 2; }

mkdir -p "$bundle/bin" "$bundle/lib" "$bundle/lib_of_compiler"
for program in "${programs[@]}"; do
  cp "$build/$program" "$bundle/bin"
done
cp "$source/bench/gpu.sh" "$source/scenes/embedded/touch_sphere.cl" "$bundle"

# glibc and its loader are the machine's own. What comes with the compiler lies apart: bench/gpu.sh takes the machine's
# where that is new enough, for the driver may need it newer than ours.
libraries="$(ldd "${programs[@]/#/$build/}" | sed -nE 's/^\t([^ ]+) => ([^ ]+) \(.*/\1 \2/p' | sort -u)"
while read -r name path; do
  case "$name" in
    libc.so.* | libm.so.* | libdl.so.* | libpthread.so.* | librt.so.* | ld-linux*) ;;
    libstdc++.so.* | libgcc_s.so.* | libgomp.so.*) cp -L "$path" "$bundle/lib_of_compiler/$name" ;;
    *) cp -L "$path" "$bundle/lib/$name" ;;
  esac
done <<<"$libraries"
[[ -e "$bundle/lib/libOpenCL.so.1" ]] || { echo "error: $build/apsl does not use a libOpenCL.so.1" >&2; exit 2; }

# As bench/measurement/machine.cpp has it.
commit="$(git -C "$source" rev-parse --short=12 HEAD 2>/dev/null || echo unknown)"
[[ -z "$(git -C "$source" status --porcelain --untracked-files=no -- ':/' ':(exclude,top)docs' 2>/dev/null)" ]] \
  || commit="$commit-dirty"
echo "$commit" >"$bundle/commit"

if grep -q '^CMAKE_CXX_FLAGS:.*-march=native' "$build/CMakeCache.txt"; then
  echo "warning: $build was built for this machine's processor alone; a build of the preset ci runs on any" >&2
fi
name="$(basename "$bundle")"
echo "$bundle: $(du -sh "$bundle" | cut -f1), commit $commit; there: $name/gpu.sh $name RESULTS"
