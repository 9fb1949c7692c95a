#!/usr/bin/env bash
# debian_test.sh SHARED_BUILD STATIC_BUILD WORK: makes the library's Debian packages from two build trees, checks what is in
# them, unpacks them into a root of their own, and builds and runs the C consumer from there, shared and static.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
shared=$1 static=$2 work=$3
rm -rf "$work"
mkdir -p "$work"
work=$(cd "$work" && pwd)

fail() {
  echo "error: $*" >&2
  exit 1
}

OUT="$work/packages" SHARED_BUILD=$shared STATIC_BUILD=$static "$here/../../cmake/make_debs.sh" --libraries
runtime=$(ls "$work"/packages/libapsl[0-9]*.deb)
development=$(ls "$work"/packages/libapsl-dev_*.deb)

# contains PACKAGE PATTERN...: each matches a path in the package
contains() {
  local files
  files=$(dpkg-deb --fsys-tarfile "$1" | tar -t)
  for pattern in "${@:2}"; do
    grep -qE "^\./usr/$pattern\$" <<<"$files" || fail "$(basename "$1") has no usr/$pattern, only:"$'\n'"$files"
  done
}
contains "$runtime" 'lib/[^/]+/libapsl\.so\.[0-9.]+' 'share/doc/libapsl[0-9.]+/(copyright|changelog\.gz)'
contains "$development" include/apsl/apsl.h include/apsl/strain_limiter.hpp 'lib/[^/]+/libapsl\.so' 'lib/[^/]+/libapsl\.a' \
  'lib/[^/]+/libapsl_core\.a' 'lib/[^/]+/pkgconfig/apsl\.pc' 'lib/[^/]+/cmake/apsl/apsl-config\.cmake' \
  'lib/[^/]+/cmake/apsl/apsl-shared-targets\.cmake' 'lib/[^/]+/cmake/apsl/apsl-static-targets\.cmake'
for needed in libc6 libstdc++6 ocl-icd-libopencl1; do
  dpkg-deb -f "$runtime" Depends | grep -qF "$needed" || fail "$(basename "$runtime") does not depend on $needed"
done
dpkg-deb -f "$development" Depends | grep -qF "$(dpkg-deb -f "$runtime" Package) (= $(dpkg-deb -f "$runtime" Version))" \
  || fail "$(basename "$development") does not depend on its own $(dpkg-deb -f "$runtime" Package)"

# CPack always calls ldconfig beside the trigger; there is no mail host, and no Debian bug to close.
tags=$(lintian --allow-root --suppress-tags \
  maintscript-calls-ldconfig,bogus-mail-host,bogus-mail-host-in-debian-changelog,initial-upload-closes-no-bugs \
  "$runtime" "$development" 2>&1) || true
grep -E '^[EW]:' <<<"$tags" && fail "lintian finds the above"

root=$work/root
for package in "$runtime" "$development"; do dpkg-deb -x "$package" "$root"; done
libraries=$(dirname "$root"/usr/lib/*/libapsl.so)
export PKG_CONFIG_PATH=$libraries/pkgconfig
for linkage in shared static; do
  # In a root of its own the linker's habit, shared first, is told off by name for the static one.
  if [[ $linkage == static ]]; then
    flags=$(pkg-config --static --cflags --libs apsl OpenCL | sed 's/-lapsl\b/-l:libapsl.a/')
  else
    flags=$(pkg-config --cflags --libs apsl OpenCL)
  fi
  # shellcheck disable=SC2086
  cc -std=c11 -Wall -Wextra -pedantic -Werror -DCL_TARGET_OPENCL_VERSION=300 "$here/consumer/main.c" -o "$work/$linkage" $flags -lm
  echo "$linkage: $(LD_LIBRARY_PATH=$libraries "$work/$linkage")"
done
