#!/usr/bin/env bash
# figures.sh [start|paint|undo|memory]: measures the window as the README states it, at 1280 x 720 on an X server of its
# own (Xvfb) with Mesa's software OpenGL; all four without an argument. Needs Xvfb and Python.
#   start   seconds from the program's start to the model ready to be painted on
#   paint   frames a second, and milliseconds from each sample of a hand at 1,000 Hz to the frame with its ink
#   undo    milliseconds of an undo, median and most of nine
#   memory  MiB at the peak, of the bowl at 4096 x 4096 with 100 strokes and of the car
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
studio=${TUFT_STUDIO:-$root/build/release/src/app/tuft-studio}

work=$(mktemp -d)
Xvfb -displayfd 3 -screen 0 1280x720x24 -nolisten tcp 3>"$work/display" 2>/dev/null &
server=$!
trap 'kill $server; rm -rf "$work"' EXIT
until [ -s "$work/display" ]; do sleep 0.1; done
export DISPLAY=:$(cat "$work/display") TUFT_DATA=$root XDG_STATE_HOME=$work/state
cd "$work"

ready() { # MODEL TEXELS
  printf 'open %s/models/%s.ply\nwait-ready\nset texels %s\nclick "Unwrap and paint"\nwait-ready\n' "$root" "$1" "$2"
}
near() { # MODEL: where strokes lie on its front
  if [ "$1" = car ]; then printf 'set azimuth 48\nset elevation 30\nset zoom 3.5\nwait 0.5\n'
  else printf 'set azimuth 20\nset elevation 10\nset zoom 4\nwait 0.5\n'; fi
}
play() { "$studio" --size 1280x720 --script "$work/script" 2>"$work/errors" || { cat "$work/errors" >&2; exit 1; }; }
# One line of reports: figures of the Python expression over `r`, the reports that were printed.
say() { python3 -c 'import json, statistics, sys
r = [json.loads(line) for line in sys.stdin if line.startswith("{")]
print(sys.argv[1], eval(sys.argv[2]))' "$1" "$2"; }

start() {
  for model in bowl:2048 car:4096; do
    for run in 1 2 3; do
      { ready "${model%:*}" "${model#*:}"; echo report; } >script
      play
    done | say "start, $model:" '"%.1f s (median of three)" % statistics.median(x["since_start"] for x in r)'
  done
}
paint() {
  for model in bowl:2048 car:4096; do
    { ready "${model%:*}" "${model#*:}"; near "${model%:*}"
      echo 'set brush wolf-medium
pace on
rate 1000
stroke 42%,50% 46%,56%
wait-ready
report'
      for k in 0 2 4 6 8; do echo "stroke 42%,$((48 + k))% 56%,$((50 + k))% 44%,$((52 + k))% 57%,$((53 + k))%"; done
      echo 'report'; } >script
    play | say "paint, $model:" '"%.0f frames/s; %.0f ms at the median, %.0f ms at 95 %%; %d samples" % tuple(r[-1][k] for k in ("frames_per_second", "delay_ms_median", "delay_ms_p95", "samples"))'
  done
}
undo() {
  for model in bowl:2048 car:4096; do
    { ready "${model%:*}" "${model#*:}"; near "${model%:*}"
      for k in 0 1 2 3 4 5 6 7 8; do echo "stroke 42%,$((46 + k))% 56%,$((50 + k))%"; done
      echo wait-ready
      for k in 0 1 2 3 4 5 6 7 8; do printf 'undo\nwait-ready\nwait 0.1\nreport\n'; done; } >script
    play | say "undo, $model:" '"%.1f ms, at most %.1f ms" % (statistics.median(x["undo_ms"] for x in r), max(x["undo_ms"] for x in r))'
  done
}
memory() {
  for model in bowl car; do
    { ready "$model" 4096; near "$model"
      for i in $(seq 0 9); do
        for j in $(seq 0 9); do echo "stroke $((40 + 2 * i))%,$((45 + j))% $((42 + 2 * i))%,$((47 + j))%"; done
        echo wait-ready
      done
      echo 'report'; } >script
    play | say "memory, $model:4096 with 100 strokes:" '"%.0f MiB, %d strokes" % (r[-1]["peak_mb"], r[-1]["strokes"])'
  done
}

if [ $# = 0 ]; then set -- start paint undo memory; fi
for figure in "$@"; do
  case $figure in start | paint | undo | memory) $figure ;; *) sed -n 2,8p "$0" >&2; exit 2 ;; esac
done
