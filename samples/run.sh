#!/usr/bin/env bash
# Installs what is missing, builds, paints the samples and says where the results are.
set -euo pipefail
cd "$(dirname "$0")/.."
. .ci/setup.sh
install_missing "${packages_build[@]}" python3
cmake_options=()
build tuft tuft_images tuft-chart tuft-patterns
tuft=build/release/src/cli/tuft
out=${1:-results}
mkdir -p "$out"
export TUFT_DATA=$PWD

# paint NAME MODEL STROKES "PAINT OPTIONS" RENDER OPTIONS..., on an atlas of 4096² texels where ATLAS says nothing else
paint() {
  local name=$1 model=$2 strokes=$3 options=$4
  shift 4
  say "$name"
  # shellcheck disable=SC2086  # several options in one word
  "$tuft" paint "models/$model.ply" --strokes "samples/strokes/$strokes.inkml" --atlas-size "${ATLAS:-4096}" $options \
    --project "$out/$name.tuft" --export "$out/$name.glb"
  "$tuft" render "$out/$name.tuft" -o "$out/$name.png" "$@"
}
paint bowl-inside bowl qi-shang-ba-xia "" --view 0,58 --light 150
paint bowl-outside bowl man-bu-ren-sheng "" --view 0,12
paint plate plate plate-ornament "" --view 0,60
paint car car car-pinstripe "--substrate clay" --view 25,12

say "a drawing on the car's door"
"$tuft" paint models/car.ply --strokes samples/strokes/roundel.svg --place 0,-270,118 --place-width 160 --substrate clay \
  --atlas-size 8192 --project "$out/door.tuft"
"$tuft" render "$out/door.tuft" -o "$out/door.png" --view 10,6 --zoom 3 --target 0,-270,130

say "wrap film for the car's door, and where it goes"
"$tuft" decals "$out/door.tuft" -o "$out/door-wrap.pdf" --max-strain 15% --bleed 8mm --page A3 --strain-map --guide "$out/door-guide"

say "a livery on the car"
livery() { "$tuft" paint "$1" --strokes samples/strokes/livery.svg --mapping project "${@:2}"; }
livery models/car.ply --only Flank --read-from front --place=-2,-216,131.8 --mirror y --readable --substrate primed-metal \
  --atlas-size 8192 --project "$out/livery.tuft"
livery "$out/livery.tuft" --only Top --read-from top --place=-2,0,330 --export "$out/livery.glb"
"$tuft" render "$out/livery.tuft" -o "$out/livery-right.png" --view 28,14 --size 740x460
"$tuft" render "$out/livery.tuft" -o "$out/livery-left.png" --view 152,14 --size 740x460
"$tuft" render "$out/livery.tuft" -o "$out/livery-top.png" --view 75,40 --size 1480x620 --zoom 0.7
oiiotool "$out/livery-top.png" "$out/livery-left.png" "$out/livery-right.png" --create 1480x1080 3 --paste +0+0 --paste +740+0 --paste +0+460 \
  -d uint8 -o "$out/livery.png"

say "stroke sheet"
"$tuft" paint models/sheet.ply --strokes samples/strokes/stroke-sheet.inkml --atlas-size 4096 \
  --project "$out/stroke-sheet.tuft"
mkdir -p "$out/stroke-sheet"
"$tuft" export "$out/stroke-sheet.tuft" -o "$out/stroke-sheet/base-colour.png"

say "brush"
"$tuft" brush goat-medium --picture "$out/brush.png" > "$out/brush.txt"

# The sheet's four corners and the bowl, on one picture.
ATLAS=2048 paint wet-sheet sheet wet-sheet "--film wet --dry 0" --view 0,89 --size 1400x1400 --zoom 1.7
ATLAS=2048 paint wet-bowl bowl wet-bowl "--film wet --dry 0 --substrate bisque" \
  --view -6,12 --size 1020x460 --zoom 2 --target -7,-68,43
paint wet-vase vase wet-vase "--film wet --dry 0" --view 20,5 --size 740x460 --zoom 2.7 --target 0,-70,97
ATLAS=2048 paint backrun sheet backrun "--film wet --dry 0 --substrate bisque" --view 0,89 --size 740x460 --zoom 3.3
sheet=$out/wet-sheet.png
oiiotool "$out/backrun.png" "$out/wet-vase.png" "$out/wet-bowl.png" "$sheet" --cut 460x460+147+796 "$sheet" --cut 560x460+712+744 \
  "$sheet" --cut 460x460+770+200 "$sheet" --cut 460x460+155+200 --create 1480x1380 3 \
  --paste +0+0 --paste +460+0 --paste +920+0 --paste +0+460 --paste +460+460 --paste +0+920 --paste +740+920 \
  -d uint8 -o "$out/wet.png"

# On paper: the same corners, and writing.
ATLAS=1400 paint paper-sheet sheet wet-sheet "--film wet --dry 0 --substrate rice-paper" --view 0,89 --size 740x740 --zoom 1.75
ATLAS=1400 paint paper-writing sheet qi-shang-ba-xia "--place 0,0,0 --place-width 150 --film wet --dry 0 --substrate rice-paper" \
  --view 0,89 --size 740x740 --zoom 1.75
oiiotool "$out/paper-writing.png" "$out/paper-sheet.png" --create 1480x740 3 --paste +740+0 --paste +0+0 -d uint8 -o "$out/paper.png"

# Eight pigments, and the same strokes shown in other inks on bisque.
paint plum vase vase-plum "" --view 0,4 --size 740x740 --zoom 3 --target 0,-60,115
"$tuft" render "$out/plum.tuft" -o "$out/plum-blue.png" --recolour cinnabar=indigo --recolour iron-red=carbon --substrate bisque \
  --view 0,4 --size 740x740 --zoom 3 --target 0,-60,115
oiiotool "$out/plum-blue.png" "$out/plum.png" --create 1480x740 3 --paste +0+0 --paste +740+0 -d uint8 -o "$out/vase-plum.png"

say "sheets of film: a water-slide decal for the plate, a wrap for the car's pinstripe, the plum's plates"
"$tuft" decals "$out/plate.tuft" -o "$out/plate-decal.pdf" --page A3 --plates --outlines
"$tuft" decals "$out/car.tuft" -o "$out/pinstripe-wrap.pdf" --max-strain 15% --bleed 8mm --page roll --guide "$out/pinstripe-guide"
"$tuft" decals "$out/plum.tuft" -o "$out/plum-plates.pdf" --plates
if command -v pdftoppm >/dev/null; then  # of poppler-utils
  pdftoppm -r 58 -singlefile -png "$out/plate-decal.pdf" "$out/plate-decal"
  pdftoppm -r 82.2 -singlefile -png "$out/plum-plates.pdf" "$out/plum-plates"
  oiiotool "$out/plum-plates.png" --cut 680x700+0+262 "$out/plate-decal.png" --cut 678x700+0+260 --create 1358x700 3 \
    --paste +0+0 --paste +678+0 -d uint8 -o "$out/decals.png"
fi

# By brushes of trades: petals of two inks, bamboo by a flat, blue-and-white, a sword's pinstripe.
paint one-stroke plate one-stroke "" --view 0,70 --zoom 2.5 --size 740x460
paint flat-bamboo sheet flat-bamboo "--substrate rice-paper" --view 0,89 --size 740x460 --zoom 1.3
paint blue-and-white vase blue-and-white "--film wet --dry 0" --view 0,4 --size 740x460 --zoom 1.8 --target 0,-60,111
paint car-sword car car-sword "--substrate clay" --view 10,8 --size 740x460
oiiotool "$out/car-sword.png" "$out/blue-and-white.png" "$out/flat-bamboo.png" "$out/one-stroke.png" --create 1480x920 3 \
  --paste +0+0 --paste +740+0 --paste +0+460 --paste +740+460 -d uint8 -o "$out/trades.png"

say "a sheet of makes"
TUFT=$tuft TEXELS=1024 samples/makes/sheet.sh "$out/makes" liner-3 rigger-3 wash-12 mop-15 wolf-medium flat-12 bright-12 filbert-12 \
  fan-30 sword-8 stippler-10 sponge-30
oiiotool "$out/makes/makes.png" --resize 1480x1101 -d uint8 -o "$out/makes.png"

paint impasto sheet impasto "--substrate bisque" --raking --view 0,89 --size 1400x1000 --zoom 2.6

say "colour chart"
build/release/samples/chart/tuft-chart "$out/colour-chart.png"

say "done: models (.glb), projects (.tuft) and pictures (.png) are in $out/"
ls -1 "$out"
