#!/usr/bin/env bash
# same_bits.sh PROGRAM...: all programs print the same line; those that cannot run here print "skipped". A program gets
# the end of its name, its level of x86-64, as its argument.
set -euo pipefail
seen=""
for program in "$@"; do
  line=$("$program" "${program##*_}")
  [ "$line" = skipped ] && { echo "$(basename "$program") skipped: the processor lacks its instructions"; continue; }
  echo "$(basename "$program") $line"
  [ -z "$seen" ] && seen=$line
  [ "$line" = "$seen" ] || { echo "bits differ"; exit 1; }
done
[ -n "$seen" ]
