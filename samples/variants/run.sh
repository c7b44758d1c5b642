#!/usr/bin/env bash
# Paints the variants of plan.toml with all cores and shows what came out. usage: run.sh [FOLDER]
set -euo pipefail
cd "$(dirname "$0")/../.."
tuft=${TUFT:-build/release/src/cli/tuft}
out=${1:-results/variants}
mkdir -p "$out"
export TUFT_DATA=$PWD
cp samples/variants/plan.toml samples/strokes/{flat-bamboo,qi-shang-ba-xia}.inkml "$out"
"$tuft" variants "$out/plan.toml" -o "$out/jobs"
"$tuft" variants "$out/jobs" --run
echo "$out/jobs: table.csv, tolerance.csv, contact-sheet-*.png, tolerance-map-*.png"
