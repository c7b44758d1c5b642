#!/usr/bin/env bash
# Installs tuft into a fresh folder, builds samples/hello as a project of its own against it, and runs that.
# find_package.sh SOURCE BUILD
set -euo pipefail
source=$1 build=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
prefix=$work/prefix
fail() { echo "FAILED: $*"; exit 1; }

cmake --install "$build" --prefix "$prefix" >"$work/log" 2>&1 || { cat "$work/log"; fail "cmake --install"; }
# Users of the libraries need GLM and nothing else to compile.
strangers=$(grep -rhE '^#include <' "$prefix/include/tuft" | grep -E '[/.]' | grep -vE '<(glm/[a-z/_]+\.hpp|immintrin\.h|sys/[a-z]+\.h|unistd\.h)>' | sort -u || true)
[ -z "$strangers" ] || fail "installed headers include other libraries: $strangers"
! grep -q -e "$source" -e "$build" "$prefix"/lib*/cmake/tuft/*.cmake "$prefix"/lib/*/cmake/tuft/*.cmake 2>/dev/null ||
  fail "the CMake package names the tree that it was built in"

cp -r "$source/samples/hello" "$work/hello"
cmake -S "$work/hello" -B "$work/build" -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_BUILD_TYPE=Release >"$work/log" 2>&1 ||
  { cat "$work/log"; fail "find_package(tuft)"; }
cmake --build "$work/build" >"$work/log" 2>&1 || { cat "$work/log"; fail "building against the installed libraries"; }
cd "$work"
said=$(TUFT_DATA=$prefix/share/tuft "$work/build/tuft-hello" "$prefix/share/tuft/models/bowl.ply" hello.glb) || fail "tuft-hello"
echo "$said"
grep -qE ' [1-9][0-9.]* mm2 of ink' <<<"$said" || fail "no ink on the model"
"$prefix/bin/tuft" inspect hello.glb | grep -q 'UVs: [0-9]* charts' || fail "the GLB has no UVs"
