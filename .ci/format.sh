#!/usr/bin/env bash
# Checks with clang-format that every source is laid out as .clang-format says, or lays them out.
#   format.sh CLANG_FORMAT --check
#   format.sh CLANG_FORMAT --write
set -euo pipefail
cd "$(dirname "$0")/.."
format=$1 what=$2
mapfile -t files < <(git ls-files --cached --others --exclude-standard -- '*.h' '*.cpp' | while read -r file; do [ -f "$file" ] && echo "$file"; done)
case $what in
  --check)
    # A process for many files: starting one takes ten times as long as to look at one.
    said=$(printf '%s\0' "${files[@]}" | xargs -0 -n 64 -P "$(nproc)" "$format" --dry-run -Werror 2>&1) ||
      { grep -oE '^[^ :]+:[0-9]+' <<<"$said" | sort -u || printf '%s\n' "$said"
        echo "are not laid out as .clang-format says; cmake --build --preset release --target format does it"; exit 1; }
    echo "${#files[@]} files are laid out as .clang-format says" ;;
  --write) printf '%s\0' "${files[@]}" | xargs -0 -n 64 -P "$(nproc)" "$format" -i ;;
esac
