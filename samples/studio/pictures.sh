#!/usr/bin/env bash
# pictures.sh [FOLDER]: takes the README's pictures of the window into FOLDER (pictures). Needs ImageMagick and Python.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
studio=${TUFT_STUDIO:-$root/build/release/src/app/tuft-studio}
out=${1:-pictures}
mkdir -p "$out"
out=$(cd "$out" && pwd)

# Scripts name files of the folder they run in; settings and recent projects of the person at the desk stay out of it.
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
ln -s "$root/models" "$work/models"
export TUFT_DATA=$root XDG_STATE_HOME=$work/state
cd "$work"
# The welcome shows Bamboo.tuft as it was last seen, so that atlas.txt comes after it.
for name in painting bowl welcome atlas car; do
  "$studio" --headless --size 1280x720 --script "$here/$name.txt"
done
python3 "$here/moving.py" studio-painting.png 728x390+306+190 560x300 frame-*.png
mv studio-*.png "$out"
echo "The pictures are in $out"
