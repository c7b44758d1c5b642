#!/usr/bin/env bash
# Installs what is missing, builds, paints the samples and says where the results are.
set -euo pipefail
cd "$(dirname "$0")/.."
. .ci/setup.sh
install_missing "${packages_build[@]}"
cmake_options=()
build tuft tuft_images
tuft=build/release/src/cli/tuft
out=${1:-results}
mkdir -p "$out"
export TUFT_DATA=$PWD

# paint NAME MODEL STROKES AZIMUTH,ELEVATION OPTIONS...
paint() {
  local name=$1 model=$2 strokes=$3 view=$4
  shift 4
  say "$name"
  "$tuft" paint "models/$model.ply" --strokes "samples/strokes/$strokes.inkml" "$@" \
    --project "$out/$name.tuft" --export "$out/$name.glb"
  "$tuft" render "$out/$name.tuft" -o "$out/$name.png" --view "$view"
}
paint bowl-inside bowl qi-shang-ba-xia 0,52 --atlas-size 4096
paint bowl-outside bowl man-bu-ren-sheng 0,12 --atlas-size 4096
paint plate plate plate-ornament 0,62 --atlas-size 4096
paint car car car-pinstripe 62,14 --atlas-size 4096

say "done: models (.glb), projects (.tuft) and pictures (.png) are in $out/"
ls -1 "$out"
