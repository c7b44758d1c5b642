#!/usr/bin/env bash
# Makes the Debian packages, has lintian look at them, installs them into a minimal system of their own, and runs the
# programs there. Takes minutes and the network, so it runs only with TUFT_TEST_PACKAGES=1, as root on Debian.
# packages.sh BUILD [CHROOT.tar]: a minimal bookworm that was made before
set -euo pipefail
build=$1 base=${2:-}
skip() { echo "skipped: $*"; exit 77; }
fail() { echo "FAILED: $*"; exit 1; }
[ "${TUFT_TEST_PACKAGES:-}" = 1 ] || skip "set TUFT_TEST_PACKAGES=1 to make a system of its own for the packages (minutes)"
[ "$(id -u)" = 0 ] || skip "needs root"
command -v dpkg-shlibdeps >/dev/null || skip "dpkg-dev is not installed"
command -v mmdebstrap >/dev/null || command -v debootstrap >/dev/null || [ -n "$base" ] || skip "neither mmdebstrap nor debootstrap is installed"

work=$(mktemp -d)
trap 'rm -rf --one-file-system "$work"' EXIT
root=$work/root
mkdir -p "$root" "$work/debs"
cpack -G DEB --config "$build/CPackConfig.cmake" -B "$work/debs" >"$work/log" 2>&1 || { cat "$work/log"; fail "cpack"; }
ls -1s "$work"/debs/*.deb
if command -v lintian >/dev/null; then
  lintian --allow-root --fail-on error "$work"/debs/*.deb || fail "lintian"
else
  echo "lintian is not installed: the packages were not looked at"
fi

if [ -n "$base" ]; then tar -C "$root" -xf "$base"
elif command -v mmdebstrap >/dev/null; then mmdebstrap --quiet --variant=minbase bookworm "$root" http://deb.debian.org/debian
else debootstrap --variant=minbase bookworm "$root" http://deb.debian.org/debian >"$work/log"
fi
cp -L /etc/resolv.conf "$root/etc/resolv.conf"
printf '#!/bin/sh\nexit 101\n' >"$root/usr/sbin/policy-rc.d"  # no services are started
chmod +x "$root/usr/sbin/policy-rc.d"
mkdir -p "$root/debs"
cp "$work"/debs/*.deb "$root/debs/"

# inside COMMAND: a shell command in that system.
inside() {
  # shellcheck disable=SC2016
  unshare -m sh -c 'mount -t proc proc "$1/proc"; exec chroot "$1" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive sh -ec "$2"' _ "$root" "$1"
}
quietly() { inside "$1" >"$work/log" 2>&1 || { tail -30 "$work/log"; fail "$1"; }; }

echo "== tuft"
quietly 'apt-get -qq update; apt-get -qq install -y --no-install-recommends /debs/tuft_*.deb'
inside 'tuft --version --json | grep -q "\"data\": \"/usr/share/tuft\""' || fail "the installed data is not found"
quietly 'cd /root; tuft paint /usr/share/tuft/models/bowl.ply --strokes /usr/share/tuft/samples/strokes/qi-shang-ba-xia.inkml \
  --atlas-size 512 --project bowl.tuft --export bowl.glb --preview bowl.png --size 320x240 --threads 2
  tuft inspect bowl.glb | grep -q "UVs: "; test -s bowl.png; tuft brush | grep -q wolf-medium
  tuft write models/bowl.ply --text 春 --style line --size 8 --atlas-size 512 --preview text.png; test -s text.png'

inside 'zcat /usr/share/man/man1/tuft.1.gz | grep -q "^\.SH NAME"' || fail "the manual page"

echo "== models by the importer"  # a program of its own, with libraries of its own
cp "$(dirname "$0")"/../fuzz/corpus/fbx/box.fbx "$(dirname "$0")"/../fuzz/corpus/dae/box.dae "$root/root/"
quietly 'cd /root; for model in box.fbx box.dae; do tuft inspect "$model" | grep "15 triangles"; done'
cp "$(dirname "$0")"/../fuzz/corpus/stp/box.stp "$(dirname "$0")"/../fuzz/corpus/igs/box.igs "$root/root/"
quietly 'cd /root; for model in box.stp box.igs; do tuft inspect "$model" | grep "12 triangles"; done'

echo "== tuft-studio"
quietly 'apt-get -qq install -y --no-install-recommends /debs/tuft-studio_*.deb libgl1-mesa-dri'
quietly 'cd /root; tuft-studio --version
  printf "open bowl.tuft\nwait-ready\nscreenshot window.png\n" > script
  tuft-studio --headless --script script; test -s window.png'

echo "== tuft-dev"
if [ "${TUFT_TEST_DEV_PACKAGE:-}" = 1 ]; then  # half a gigabyte of other libraries
  quietly 'apt-get -qq install -y --no-install-recommends /debs/tuft-dev_*.deb g++ cmake make pkg-config
    cp -r /usr/share/doc/tuft-dev/examples/hello /root/hello; cd /root/hello
    cmake -B build -DCMAKE_BUILD_TYPE=Release; cmake --build build
    build/tuft-hello /usr/share/tuft/models/vase.ply hello.glb | grep -E " [1-9][0-9.]* mm2 of ink"'
else
  echo "skipped: set TUFT_TEST_DEV_PACKAGE=1 to build a program with it"
fi

echo "== removal"
quietly 'apt-get -qq purge -y "tuft*"'
left=$(inside 'find / -xdev -path /root -prune -o -path /proc -prune -o -path /debs -prune -o -path /var -prune -o -name "*tuft*" -print')
[ -z "$left" ] || fail "left behind: $left"
echo "the packages install, run and go"
