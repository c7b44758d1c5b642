#!/usr/bin/env bash
# clang-tidy over modules of src/, with the checks of .clang-tidy: tidy.sh CLANG_TIDY BUILD MODULE...
set -euo pipefail
cd "$(dirname "$0")/.."
tidy=$1 build=$2
shift 2
find "${@/#/src/}" -name '*.cpp' -print0 |
  xargs -0 -P "$(nproc)" -n 1 "$tidy" -p "$build" --quiet --extra-arg=-Wno-unknown-warning-option
