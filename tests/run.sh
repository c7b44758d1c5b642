#!/usr/bin/env bash
# Installs what is missing, builds everything and runs every test.
set -euo pipefail
cd "$(dirname "$0")/.."
. .ci/setup.sh
install_missing "${packages_build[@]}" "${packages_test[@]}"
# What the tests only run is fetched while the programs are compiled.
{
  install_missing "${packages_run[@]}"
  # The Khronos glTF validator; the tests that need it say so and are skipped without it.
  if command -v npm >/dev/null && [ ! -d build/node/node_modules/gltf-validator ]; then
    mkdir -p build/node
    npm install --silent --no-fund --no-audit --prefix build/node gltf-validator@2.0.0-dev.3.10 >/dev/null 2>&1 ||
      say "the glTF validator could not be installed; its test will be skipped"
  fi
} &
installing=$!
cmake_options=(-DTUFT_TESTS=ON)
build all || { wait; exit 1; }
wait "$installing"
say "testing"
tests_at_once=$(( $(nproc) + 1 ))  # some of them wait for a window, a server or a program
if [ $# -gt 0 ]; then
  ctest --preset release --parallel "$tests_at_once" "$@"
else  # the quick ones first, and the others whatever they say
  failed=0
  ctest --preset release --parallel "$tests_at_once" -L fast || failed=1
  ctest --preset release --parallel "$tests_at_once" -LE fast || failed=1
  exit $failed
fi
