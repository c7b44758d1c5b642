#!/usr/bin/env bash
# Paints what each make of brush does: dots; straight; edge and broad side; a turn; an S; press and lift; dry hair; a sharp
# corner. usage: sheet.sh [FOLDER [BRUSH...]]; a picture for each make, and makes.png of all.
set -euo pipefail
cd "$(dirname "$0")/../.."
tuft=${TUFT:-build/release/src/cli/tuft}
out=${1:-results/makes}
shift || true
mkdir -p "$out"
export TUFT_DATA=$PWD
side=${TEXELS:-2048}

# value FILE KEY [OTHERWISE]
value() { sed -n "s/^$2 *= *//p" "$1" | grep . || echo "${3:-0}"; }
paint() {
  local name=$1 file=models/brushes/$1.toml length radius wide width
  length=$(value "$file" length_mm)
  radius=$(value "$file" radius_mm)
  wide=$(value "$file" width_mm)
  case $name in fan-*) wide=${name#fan-} ;; esac
  width=$(awk -v w="$wide" -v r="$radius" 'BEGIN { print (w > 2 * r ? w : 2 * r) }')
  python3 samples/makes/sheet.py "$name" "$length" "$width" "$(awk -v w="$wide" -v s="$(value "$file" slant_mm)" 'BEGIN { print (w > 0) + (s > 0) }')" "$out"
  "$tuft" paint "$out/$name.obj" --unit mm --up z --keep-uv --strokes "$out/$name.inkml" --atlas-size "$side" --quiet \
    --project "$out/$name.tuft"
  rm -f "$out/$name"-*.png
  "$tuft" export "$out/$name.tuft" -o "$out/$name-base-colour.png" --quiet
  # The sheet is the upper 5/9 of the atlas.
  oiiotool "$out/$name-base-colour.png" --ch R,G,B --cut "${side}x$((5 * side / 9))+0+0" -o "$out/$name.png"
}
makes=("$@")
[ $# -gt 0 ] || makes=($(cd models/brushes && ls *.toml | sed 's/\.toml//'))
tiles=()
for name in "${makes[@]}"; do
  paint "$name"
  tiles+=("$out/$name.png" --resize 900x500)
done
rows=$(((${#makes[@]} + 2) / 3))
oiiotool "${tiles[@]}" --mosaic:pad=6 3x"$rows" -d uint8 -o "$out/makes.png"
