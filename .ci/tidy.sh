#!/usr/bin/env bash
# clang-tidy over modules of src/, with the checks of .clang-tidy: tidy.sh CLANG_TIDY BUILD MODULE...
set -euo pipefail
cd "$(dirname "$0")/.."
tidy=$1 build=$2
shift 2
# Tests compile some sources again for other instruction sets. clang-tidy would look at a source once for each command.
mkdir -p "$build/tidy"
awk '/^\{/ { record = "" } { record = record $0 "\n" }
     /^\}/ { sub(/\},?\n$/, "}", record); if (record ~ / -o src\//) { printf "%s%s", n++ ? ",\n" : "[\n", record } }
     END { print "\n]" }' "$build/compile_commands.json" > "$build/tidy/compile_commands.json"
find "${@/#/src/}" -name '*.cpp' -print0 |
  xargs -0 -P "$(nproc)" -n 1 "$tidy" -p "$build/tidy" --quiet --extra-arg=-Wno-unknown-warning-option
