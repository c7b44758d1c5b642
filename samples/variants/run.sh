#!/usr/bin/env bash
# Paints the variants of a plan with all cores and shows what came out. usage: run.sh [FOLDER] [PLAN]
set -euo pipefail
cd "$(dirname "$0")/../.."
tuft=${TUFT:-build/release/src/cli/tuft}
out=${1:-results/variants}
plan=${2:-samples/variants/plan.toml}
mkdir -p "$out"
export TUFT_DATA=$PWD
"$tuft" variants "$plan" -o "$out/jobs"
"$tuft" variants "$out/jobs" --run
echo "$out/jobs: table.csv, tolerance.csv, contact-sheet-*.png, tolerance-map-*.png"
