#!/usr/bin/env bash
# Checks with clang-format that sources are laid out as .clang-format says, or lays them out.
#   format.sh CLANG_FORMAT --check          what .ci/formatted.txt lists
#   format.sh CLANG_FORMAT --write          the same
#   format.sh CLANG_FORMAT --list           makes the list anew: every source that is laid out so
#   format.sh CLANG_FORMAT --write-all      every source; then the list can go, and all are checked
set -euo pipefail
cd "$(dirname "$0")/.."
format=$1 what=$2
sources() { git ls-files -- '*.h' '*.cpp'; }
if [ -f .ci/formatted.txt ] && [[ $what == --check || $what == --write ]]; then
  # Files that are gone or have another name now are not missed.
  mapfile -t files < <(grep -v '^#' .ci/formatted.txt | while read -r file; do [ -f "$file" ] && echo "$file"; done)
else
  mapfile -t files < <(sources)
fi
# Those of the files that are laid out otherwise.
differing() {
  printf '%s\0' "${files[@]}" | xargs -0 -n 8 -P "$(nproc)" bash -c \
    'format=$0; for file; do "$format" "$file" | cmp -s - "$file" || echo "$file"; done' "$format"
}
case $what in
  --list)
    { echo "# Sources that are laid out as .clang-format says; .ci/format.sh checks them. Gone once all are."
      comm -23 <(printf '%s\n' "${files[@]}" | LC_ALL=C sort) <(differing | LC_ALL=C sort); } >.ci/formatted.new
    mv .ci/formatted.new .ci/formatted.txt ;;
  --check)
    bad=$(differing)
    [ -z "$bad" ] || { printf '%s\n' "$bad"; echo "are not laid out as .clang-format says; cmake --build --preset release --target format does it"; exit 1; }
    echo "${#files[@]} files are laid out as .clang-format says" ;;
  --write|--write-all) printf '%s\0' "${files[@]}" | xargs -0 -n 16 -P "$(nproc)" "$format" -i ;;
esac
