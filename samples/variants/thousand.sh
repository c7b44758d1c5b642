#!/usr/bin/env bash
# 1,000 variants of a line on a small sheet: the same table by 1 and by 4 workers, and by workers of which one is killed
# every half a second in which a variant was done, with the process that starts them killed twice.
# usage: thousand.sh [FOLDER] [SAMPLES], samples of each tolerance: 62 make 1,000 variants.
set -euo pipefail
cd "$(dirname "$0")/../.."
tuft=$(realpath "${TUFT:-build/release/src/cli/tuft}")
out=${1:-results/thousand}
samples=${2:-62}
mkdir -p "$out"
export TUFT_DATA=$PWD
cat >"$out/sheet.obj" <<'END'
v -20 -15 0
v 20 -15 0
v 20 15 0
v -20 15 0
f 1 2 3 4
END
cp samples/strokes/car-pinstripe.inkml "$out/line.inkml"
cat >"$out/plan.toml" <<END
models = [{ file = "sheet.obj", unit = "mm", up = "z", atlas_size = 128 }]
strokes = ["line.inkml"]
inks = ["carbon", "cinnabar", "indigo", "gamboge"]
brushes = ["wolf-small", "mixed-small"]
[placement]
side = "top"
width_mm = 25
[picture]
of = "planned"
width = 64
height = 48
[[tolerance]]
name = "jig"
samples = $samples
shift_mm = 1
turn_deg = 2
[[tolerance]]
name = "hand"
samples = $samples
hand_mm = 0.4
pressure = 0.1
END
# All but the seconds.
table() { python3 -c 'import csv, sys
for row in csv.reader(open(sys.argv[1])): print([v for i, v in enumerate(row) if i != 17])' "$1/table.csv"; }
for n in 1 4; do
  "$tuft" variants "$out/plan.toml" -o "$out/by-$n" --run --quiet --threads "$n" &
done
"$tuft" variants "$out/plan.toml" -o "$out/killed" --quiet
kills=0 seen=0
for run in 1 2 3; do
  "$tuft" variants "$out/killed" --run --quiet --threads 4 >/dev/null 2>"$out/killed.err" &
  parent=$!
  for _ in $(seq "$([ $run = 3 ] && echo 100000 || echo 12)"); do
    sleep 0.5
    kill -0 $parent 2>/dev/null || break
    done=$(ls "$out/killed/results" 2>/dev/null | wc -l)
    [ "$done" -gt "$seen" ] || continue  # on a busy machine a variant takes longer than half a second
    seen=$done
    worker=$(ps -o pid= --ppid $parent | shuf -n 1)
    [ -z "$worker" ] || { kill -KILL $worker 2>/dev/null && kills=$((kills + 1)); } || true
  done
  [ $run = 3 ] || kill -KILL $parent 2>/dev/null || true
  wait $parent 2>/dev/null || true
done
wait
for run in by-1 by-4 killed; do table "$out/$run" >"$out/$run.txt"; done
echo "$(grep -c done "$out/by-1.txt") variants done by 1 worker; killed: $kills workers and 2 starters"
cmp "$out/by-1.txt" "$out/by-4.txt" && echo "1 and 4 workers: the same table"
cmp "$out/by-1.txt" "$out/killed.txt" && echo "killed and resumed: the same table"
ls "$out/killed/results" | wc -l
