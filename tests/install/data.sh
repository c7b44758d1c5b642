#!/usr/bin/env bash
# What the programs read and the README names is installed with them, and is found from any folder: data.sh SOURCE BUILD
set -euo pipefail
source=$1 build=$2
unset TUFT_DATA
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "FAILED: $*"; exit 1; }

cmake --install "$build" --prefix "$work/there" --component tuft >"$work/log" || { cat "$work/log"; fail "cmake --install"; }
shared=$work/there/share/tuft
cd "$source"
named=0
while read -r file; do
  [ -s "$shared/$file" ] || fail "$file is not installed"
  named=$((named + 1))
done < <(find models samples/strokes samples/inks samples/variants -type f ! -name '*.cpp' ! -name '*.h' ! -name '*.sh' ! -name CMakeLists.txt)
[ "$named" -gt 100 ] || fail "only $named files of data"

mkdir "$work/home"
cd "$work/home"
tuft() { HOME=$work/home XDG_CACHE_HOME=$work/cache "$work/there/bin/tuft" "$@" >"$work/log" 2>&1 || { cat "$work/log"; fail "tuft $*"; }; }
tuft inspect models/sheet.ply
tuft write models/sheet.ply --text 'A 上' --style line --size 20 --atlas-size 128 --project text.tuft
grep -q "mm2 of ink\|strokes" "$work/log" || { cat "$work/log"; fail "nothing is written"; }
tuft variants samples/variants/plan.toml -o jobs
TUFT_DATA='' tuft brush wolf-small
