#!/usr/bin/env bash
# 1,000 variants of a dash of 4 mm on a small sheet: the same table by one worker, and by four of which one is killed
# after every 20 variants, with the process that starts them killed twice. None is lost and none is there twice.
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
cat >"$out/dash.inkml" <<'END'
<ink xmlns="http://www.w3.org/2003/InkML">
  <definitions>
    <traceFormat xml:id="format">
      <channel name="X" type="decimal" units="mm"/>
      <channel name="Y" type="decimal" units="mm"/>
      <channel name="P" type="decimal" min="0" max="1"/>
      <channel name="T" type="decimal" units="ms"/>
    </traceFormat>
    <context xml:id="pen" traceFormatRef="#format"/>
  </definitions>
  <trace contextRef="#pen">0 0 0 0, 0.5 0 0.2 20, 1 0 0.4 40, 2 0 0.5 80, 3 0 0.4 120, 3.5 0 0.2 140, 4 0 0 160</trace>
</ink>
END
cat >"$out/plan.toml" <<END
models = [{ file = "sheet.obj", unit = "mm", up = "z", atlas_size = 64 }]
strokes = ["dash.inkml"]
inks = ["carbon", "cinnabar", "indigo", "gamboge"]
brushes = ["wolf-small", "liner-3"]
[placement]
side = "top"
width_mm = 4
[picture]
of = "planned"
width = 32
height = 24
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
finished() { { find "$out/killed/results" -mindepth 1 -maxdepth 1 2>/dev/null || true; } | wc -l; }
"$tuft" variants "$out/plan.toml" -o "$out/by-1" --run --quiet --threads 1 >/dev/null &
"$tuft" variants "$out/plan.toml" -o "$out/killed" --quiet >/dev/null
all=$(ls "$out/killed/tasks" | wc -l)
kills=0 next=20
for run in 1 2 3; do
  "$tuft" variants "$out/killed" --run --quiet --threads 4 >/dev/null 2>"$out/killed.err" &
  parent=$!
  while kill -0 $parent 2>/dev/null; do
    sleep 0.2
    n=$(finished)
    [ $run -lt 3 ] && [ "$n" -ge $((run * all / 3)) ] && break
    [ "$n" -ge $next ] || continue
    next=$((n + 20))
    worker=$(ps -o pid= --ppid $parent | shuf -n 1 || true)
    [ -z "$worker" ] || { kill -KILL $worker 2>/dev/null && kills=$((kills + 1)); } || true
  done
  [ $run = 3 ] || kill -KILL $parent 2>/dev/null || true
  wait $parent 2>/dev/null || true
done
wait
for run in by-1 killed; do table "$out/$run" >"$out/$run.txt"; done
echo "$(grep -c done "$out/by-1.txt") variants done by 1 worker; killed: $kills workers of 4 and 2 starters"
cmp "$out/by-1.txt" "$out/killed.txt" && echo "1 worker, and 4 killed and resumed: the same table"
diff -r "$out/by-1/results" "$out/killed/results" -x '*.json' && echo "$(finished) results, with the same coverage"
