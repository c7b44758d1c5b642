#!/usr/bin/env bash
# check_documents.sh SOURCE: every link of the documents, and every path of a file in `back quotes`, leads to what exists.
set -euo pipefail
cd "$1"
bad=0
missing() { echo "$1: $2"; bad=1; }
while read -r document; do
  folder=$(dirname "$document")
  while read -r target; do
    path=${target%%#*}
    [[ -z $path || $path == *://* || -e $folder/$path ]] || missing "$document" "link to $target"
  done < <(grep -oE '\]\([^)[:space:]]+\)' "$document" | sed -E 's/^\]\((.*)\)$/\1/')
  # Commands in indented blocks name files of the user.
  while read -r path; do
    [[ -e $path || -e src/$path || -e $folder/$path ]] || missing "$document" "$path"
  done < <(grep -v '^    ' "$document" | grep -oE '`[A-Za-z0-9_./-]+/[A-Za-z0-9_.-]+\.(h|cpp|sh|toml|md|txt|cmake)`' | tr -d '`')
done < <(find README.md src tests samples models -name '*.md' -not -path '*/build/*')
exit $bad
