#!/usr/bin/env bash
# Makes the Debian packages, installs them in a fresh Debian of this machine's release (debootstrap, minbase, from its
# mirror) with nothing but what they depend on, and there builds and runs the consumers and the program. As root; a few
# minutes.
# Arguments and environment are those of cmake/make_debs.sh: --libraries leaves out the program.
set -euo pipefail
cd "$(dirname "$0")/../.."
[[ "$(id -u)" -eq 0 ]] || { echo "error: debootstrap and chroot need root" >&2; exit 1; }
cmake/debian_packages.sh --tests

packages=${OUT:-build/debian}
cmake/make_debs.sh "$@"

root=$(mktemp -d)
chmod 755 "$root"
clean_up() {
  for mounted in proc sys dev; do
    if mountpoint -q "$root/$mounted"; then umount "$root/$mounted"; fi
  done
  rm -rf --one-file-system "$root"
}
trap clean_up EXIT
release=$(. /etc/os-release && echo "$VERSION_CODENAME")
mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' "Codename: $release" | head -n 1)
[[ -n "$mirror" ]] || { echo "error: apt has no mirror of \"$release\", expected this machine's release of Debian" >&2; exit 1; }
debootstrap --variant=minbase "$release" "$root" "$mirror"

# pocl asks these what processors and memory there are.
mount -t proc proc "$root/proc"
mount --bind -o ro /sys "$root/sys"
mount --bind /dev "$root/dev"
cp /etc/resolv.conf "$root/etc/resolv.conf"
for settings in /etc/apt/apt.conf.d/*; do
  if grep -qiE 'proxy|verify-peer' "$settings"; then cp "$settings" "$root/etc/apt/apt.conf.d/"; fi
done
mkdir "$root/packages"
cp "$packages"/*.deb "$root/packages/"
cp -r tests/install_consumer/consumer "$root/consumer"

inside() {
  echo "in the clean system: $*"
  chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root DEBIAN_FRONTEND=noninteractive \
    OCL_ICD_VENDORS=/etc/OpenCL/vendors/pocl.icd bash -euo pipefail -c "$*"
}
inside apt-get update -qq
inside "apt-get install -y -qq --no-install-recommends /packages/*.deb >/dev/null"
inside dpkg --audit
if compgen -G "$packages/apsl_*.deb" >/dev/null; then
  inside apsl --version
fi
# What a program that is built there needs besides: a compiler, CMake, pkg-config, an OpenCL device.
inside "apt-get install -y -qq --no-install-recommends g++ make cmake pkg-config pocl-opencl-icd >/dev/null"
for linkage in shared static; do
  inside "cmake -S /consumer -B /build_$linkage -DWAY=find_package -DAS_COMPONENT=ON -DLINKAGE=$linkage >/dev/null"
  inside "cmake --build /build_$linkage"
  inside /build_$linkage/consumer_c
  inside /build_$linkage/consumer_cpp
done
inside "cc -std=c11 -DCL_TARGET_OPENCL_VERSION=300 /consumer/main.c -o /consumer_c \$(pkg-config --cflags --libs apsl OpenCL) -lm"
inside /consumer_c
if compgen -G "$packages/apsl_*.deb" >/dev/null; then
  inside apsl run /usr/share/apsl/scenes/curtain.json --frames 2
fi
inside "apt-get purge -y -qq 'libapsl*' >/dev/null"  # takes the program along
inside "! find /usr /etc -name '*apsl*' | grep ."
echo "clean system: packages installed, consumers built and run, packages removed, nothing left behind"
