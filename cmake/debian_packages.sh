#!/usr/bin/env bash
# Installs what a Debian 12 or 13 machine needs to build, run and test apsl. As root, or with sudo.
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
optional=()  # their tests are skipped, with a line that says so, where the release does not have them
if [[ "${1:-}" == "--tests" ]]; then
  packages+=(
    catch2 libbenchmark-dev libviennacl-dev python3-jsonschema git
    # the library as a package: HTML documentation, binary interface, pkg-config, Debian packages, a clean system
    doxygen abigail-tools binutils pkg-config lintian debootstrap
    # the Python module in a virtual environment
    python3-dev python3-venv python3-pyopencl
    # kernels to AMD machine code, and the formatter; a|b: Debian 12's name, or Debian 13's
    clang-19 clang-format-19 "rocm-device-libs|rocm-device-libs-17"
    # the machine code, interpreted
    python3-numpy
    # the fuzzers of the readers
    libclang-rt-19-dev
  )
  optional+=(oclgrind)  # not in Debian 13
fi
if [[ "${1:-}" == "--blender" ]]; then
  # what Blender as a Python module (tests/scenes/viewers/blender.sh) finds on any desktop
  packages+=(python3-venv libgl1 libice6 libsm6 libx11-6 libxfixes3 libxi6 libxkbcommon0 libxrender1)
fi

is_installed() {
  [[ "$(dpkg-query -W -f='${db:Status-Abbrev}' "$1" 2>/dev/null)" == ii* ]]
}

# Those of "$@" that are not installed, one a line; of a|b neither is.
not_installed() {
  local names name
  for names in "$@"; do
    for name in ${names//|/ }; do
      if is_installed "$name"; then continue 2; fi
    done
    echo "$names"
  done
}

# The first of a|b that the archive has; nothing where it has none.
in_archive() {
  local name
  for name in ${1//|/ }; do
    if [[ "$(LC_ALL=C apt-cache policy "$name")" == *"Candidate: "[0-9]* ]]; then
      echo "$name"
      return
    fi
  done
}

# apt's status lines in, a line out at every tenth of the way: apt itself says either nothing or a thousand lines.
show_progress() {
  local line doing said=""
  while read -r line; do
    [[ "$line" =~ ^(dlstatus|pmstatus):.*:([0-9]+)\.[0-9]*:[^:]*$ ]] || continue
    [[ "${BASH_REMATCH[1]}" == dlstatus ]] && doing=fetching || doing=installing
    doing+=": $((BASH_REMATCH[2] / 10 * 10)) %"
    [[ "$doing" == "$said" ]] || echo "$doing"
    said=$doing
  done
}

install() {
  echo "installing: $*"
  # A status descriptor of its own: apt closes it for dpkg, whose scripts need their standard output.
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive bash -c 'exec "$@" 3>&1 >/dev/null' bash \
    apt-get install -y -q --no-install-recommends -o APT::Status-Fd=3 "$@" | show_progress
}

mapfile -t missing < <(not_installed "${packages[@]}")
mapfile -t missing_optional < <(not_installed "${optional[@]}")
[[ ${#missing[@]} -eq 0 && ${#missing_optional[@]} -eq 0 ]] && exit 0

as_root=()
if [[ "$(id -u)" -ne 0 ]]; then
  as_root=(sudo)
fi
if [[ ${#missing[@]} -gt 0 ]]; then
  [[ "$(id -u)" -eq 0 ]] || command -v sudo >/dev/null \
    || { echo "error: installing ${missing[*]} needs root or sudo" >&2; exit 1; }
  echo "updating the lists of packages"
  "${as_root[@]}" apt-get update -qq
  required=()
  for names in "${missing[@]}"; do
    name=$(in_archive "$names")
    [[ -n "$name" ]] || { echo "error: the archive has no package $names, expected Debian 12 or 13" >&2; exit 1; }
    required+=("$name")
  done
  install "${required[@]}"
fi
for name in "${missing_optional[@]}"; do
  if [[ -z "$(in_archive "$name")" ]]; then
    echo "not installed: $name, which the archive does not have: its tests are skipped" >&2
  else
    install "$name" || echo "not installed: $name: its tests are skipped" >&2
  fi
done
