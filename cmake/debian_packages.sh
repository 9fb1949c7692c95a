#!/usr/bin/env bash
# Installs what a Debian 12 machine needs to build, run and test apsl. As root, or with sudo.
set -euo pipefail

packages=(
  # the library
  build-essential cmake ninja-build ocl-icd-opencl-dev opencl-c-headers
  # Debian packages of it
  file gzip
  # an OpenCL device for machines without a GPU
  pocl-opencl-icd
  # the reference and the program
  libeigen3-dev libcli11-dev nlohmann-json3-dev opencl-clhpp-headers
  # pictures and charts
  python3 python3-vtk9 python3-matplotlib python3-pil xvfb xauth
)
if [[ "${1:-}" == "--tests" ]]; then
  packages+=(
    catch2 libbenchmark-dev libviennacl-dev python3-jsonschema oclgrind git
    # the library as a package: HTML documentation, binary interface, pkg-config, Debian packages, a clean system
    doxygen abigail-tools binutils pkg-config lintian debootstrap
    # the Python module in a virtual environment
    python3-dev python3-venv python3-pyopencl
    # kernels to AMD machine code, and the formatter
    clang-19 clang-format-19 rocm-device-libs
    # the machine code, interpreted
    python3-numpy
    # the fuzzers of the readers
    libclang-rt-19-dev
  )
fi
if [[ "${1:-}" == "--blender" ]]; then
  # what Blender as a Python module (tests/scenes/viewers/blender.sh) finds on any desktop
  packages+=(python3-venv libgl1 libice6 libsm6 libx11-6 libxfixes3 libxi6 libxkbcommon0 libxrender1)
fi

missing=()
for package in "${packages[@]}"; do
  [[ "$(dpkg-query -W -f='${db:Status-Abbrev}' "$package" 2>/dev/null)" == ii* ]] || missing+=("$package")
done
[[ ${#missing[@]} -eq 0 ]] && exit 0

as_root=()
if [[ "$(id -u)" -ne 0 ]]; then
  command -v sudo >/dev/null || { echo "error: installing ${missing[*]} needs root or sudo" >&2; exit 1; }
  as_root=(sudo)
fi
echo "installing: ${missing[*]}"
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
