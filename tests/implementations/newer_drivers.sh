#!/usr/bin/env bash
# Runs the kernels' tests on the OpenCL drivers of Debian testing, pocl and Mesa's rusticl on llvmpipe, each test in a
# process and within a time of its own: a driver that crashes or hangs over one does not hide the others.
# Usage: tests/implementations/newer_drivers.sh ROOT [SELECTION], as root, with debootstrap and a built preset ci. ROOT is
# where Debian testing goes, some 1.5 GB; SELECTION is Catch2's, "~[lifetimes]" where none is given.
set -euo pipefail
[[ $# -ge 1 && $# -le 2 ]] || { echo "usage: $0 ROOT [SELECTION]" >&2; exit 2; }
mkdir -p "$1"
root=$(realpath "$1")
selection=${2:-~[lifetimes]}
cd "$(dirname "$0")/../.."
build=$PWD/build/ci
[[ -x $build/tests/kernels/apsl_kernel_tests ]] || { echo "$0: no $build/tests/kernels/apsl_kernel_tests: build the preset ci" >&2; exit 2; }
if [[ ! -e $root/etc/OpenCL/vendors/rusticl.icd ]]; then
  debootstrap --variant=minbase --include=pocl-opencl-icd,mesa-opencl-icd,ocl-icd-libopencl1,libstdc++6,clinfo testing "$root" \
    http://deb.debian.org/debian /usr/share/debootstrap/scripts/sid
fi
mkdir -p "$root/tests"
cp "$build/tests/kernels/apsl_kernel_tests" "$root/tests/"
in_root() { chroot "$root" /usr/bin/env -i PATH=/usr/bin:/bin HOME=/root LANG=C.UTF-8 RUSTICL_ENABLE=llvmpipe "$@"; }
mounted=()
leave() { for place in "${mounted[@]}"; do umount "$root/$place"; done; }
trap leave EXIT
for place in proc sys dev; do mount --bind "/$place" "$root/$place" && mounted=("$place" "${mounted[@]}"); done

in_root clinfo --raw | grep -E 'CL_PLATFORM_NAME|CL_DEVICE_NAME|CL_DRIVER_VERSION'
mapfile -t tests < <(in_root /tests/apsl_kernel_tests "$selection" --list-test-names-only)
failed=0
for platform in Portable rusticl; do
  passed=0
  for test in "${tests[@]}"; do
    [[ -n $test ]] || continue
    status=0
    in_root APSL_TEST_PLATFORM=$platform timeout -k 5 180 /tests/apsl_kernel_tests "${test//,/\\,}" >"$root/tests/log" 2>&1 </dev/null || status=$?
    case $status in
      0) passed=$((passed + 1)); continue ;;
      124 | 137) why="takes longer than 180 s" ;;
      13[0-9]) why="the driver ends the process" ;;
      *) why="fails" ;;
    esac
    failed=$((failed + 1))
    echo "$platform: $why: $test"
    grep -m1 -A3 'FAILED:' "$root/tests/log" | sed 's/^/    /' || true
  done
  echo "$platform: $passed of ${#tests[@]} tests pass"
done
exit $((failed > 0))
