#!/usr/bin/env bash
# The same strokes by tuft, by Blender's texture paint and by libmypaint, by turns, one thread or CPU time: stamps a
# second, 64 and 256 texels wide, a texel apart. Blender paints a sphere of 100,000 triangles on 4096² texels, as tuft
# does; libmypaint paints a flat canvas. Neither bends a brush. Installs blender, libmypaint-dev and xvfb where they are
# missing. usage: compare.sh [FOLDER]; prints a table, and writes it to FOLDER/compare.md
set -euo pipefail
cd "$(dirname "$0")/../.."
. .ci/setup.sh
out=${1:-results/compare}
tuft=${TUFT:-build/release/src/cli/tuft}
rounds=${ROUNDS:-3}
mkdir -p "$out"
out=$(realpath "$out")
export TUFT_DATA=$PWD
install_missing blender libmypaint-dev xvfb xauth pkg-config gcc
read -ra mypaint < <(pkg-config --cflags --libs libmypaint)
gcc -O2 samples/bench/mypaint_dabs.c -o "$out/mypaint_dabs" "${mypaint[@]}" -lm

rm -f "$out"/*.json
for round in $(seq "$rounds"); do
  say "round $round of $rounds"
  # Two sizes of one program's stamps come from one run of it.
  "$tuft" bench --quick --atlas-size 4096 --json --quiet >"$out/tuft-$round.json"
  for width in 64 256; do
    "$out/mypaint_dabs" $width 4000 >"$out/mypaint-$width-$round.json"
    LIBGL_ALWAYS_SOFTWARE=1 timeout 600 xvfb-run -a -s "-screen 0 1280x1024x24" blender --factory-startup --threads 1 \
      --python samples/bench/blender_paint.py -- 4096 $width 200 "$out/blender-$width-$round.json" \
      >"$out/blender.log" 2>&1 || { tail -n 3 "$out/blender.log" >&2; }
  done
done
python3 - "$out" "$rounds" <<'END' | tee "$out/compare.md"
import glob
import json
import statistics
import sys

out, rounds = sys.argv[1], int(sys.argv[2])
ours = [json.load(open(f)) for f in sorted(glob.glob(out + "/tuft-*.json"))]
model = "sphere-100k"


def median(values):
    return f"{statistics.median(values):,.0f}" if values else "not measured"


def others(name, width):
    return [json.load(open(f))["stamps_per_second"] for f in glob.glob(f"{out}/{name}-{width}-*.json")]


print(f"{ours[0]['machine']}; medians of {rounds} rounds by turns; stamps a second")
print()
print("| | 64 texels | 256 texels |")
print("|---|---|---|")
rows = [("tuft, whole path with contact and bending, 100,000 triangles",
         [median([j["models"][model]["stamps_per_second"][w] for j in ours]) for w in ("64", "256")]),
        ("tuft, one stamp put on texels",
         [median([1e6 / j["models"][model]["microseconds_per_stamp"][w] for j in ours]) for w in ("64", "256")])]
for name, title in (("blender", "Blender, texture paint, 100,000 triangles"), ("mypaint", "libmypaint, flat canvas")):
    rows.append((title, [median(others(name, w)) for w in (64, 256)]))
for title, values in rows:
    print(f"| {title} | {' | '.join(values)} |")
END
