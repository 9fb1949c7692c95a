#!/usr/bin/env bash
# Makes the Debian packages libapsl1, libapsl-dev and apsl in build/debian. --libraries leaves out the program.
# STATIC_BUILD and SHARED_BUILD name build trees to take the libraries from instead of building them there.
set -euo pipefail
cd "$(dirname "$0")/.."

cmake/debian_packages.sh
program=ON
[[ "${1:-}" == "--libraries" ]] && program=OFF
out=${OUT:-build/debian}
shared=${SHARED_BUILD:-build/debian/shared}
static=${STATIC_BUILD:-build/debian/static}
mkdir -p "$out"

common=(-G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX=/usr -DAPSL_BUILD_TESTS=OFF -DAPSL_BUILD_COMPARE=OFF)
if [[ -z "${SHARED_BUILD:-}" ]]; then
  cmake -S . -B "$shared" "${common[@]}" -DBUILD_SHARED_LIBS=ON -DAPSL_BUILD_PROGRAM=$program -DAPSL_BUILD_REFERENCE=$program
  cmake --build "$shared"
fi
if [[ -z "${STATIC_BUILD:-}" ]]; then
  cmake -S . -B "$static" "${common[@]}" -DAPSL_BUILD_PROGRAM=OFF -DAPSL_BUILD_REFERENCE=$program
  cmake --build "$static"
fi
shared=$(realpath "$shared") static=$(realpath "$static") out=$(realpath "$out")
rm -f "$out"/*.deb
(umask 022; cd "$shared" && cpack -G DEB -B "$out/cpack" -D "CPACK_INSTALL_CMAKE_PROJECTS=$shared;apsl;ALL;/;$static;apsl;ALL;/")
mv "$out"/cpack/*.deb "$out/"
rm -rf "$out/cpack"
ls "$out"/*.deb
