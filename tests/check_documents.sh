#!/usr/bin/env bash
# check_documents.sh SOURCE: what documents and comments name exists.
# - Documents: the targets of links, paths of files in `back quotes`, files of the code by their bare names, such as
#   (deposit.h). READMEs of src/: names of functions and types in `back quotes`, and in the file that is named behind one,
#   `choose_step` (`film/film_step.cpp`). Names with a capital NAME are patterns.
# - Commands in documents: subcommands of `tuft` and their options, suites of tests.
# - Comments of headers: names in `back quotes`.
# - Keys of sources, such as [Huang2018]; no source is cited by names and year. The folders in the table of modules in
#   src/README.md.
set -euo pipefail
export LC_ALL=C
cd "$1"
bad=0
missing() { echo "$1: $2"; bad=1; }
lists=$(mktemp -d)
trap 'rm -rf "$lists"' EXIT
code() {
  find src tests samples models -type f \( -name '*.h' -o -name '*.cpp' -o -name '*.cmake' -o -name CMakeLists.txt \) "$@"
}
code -print | sed 's|.*/||' | sort -u > "$lists/files"
code -print0 | xargs -0 grep -ohE '[A-Za-z_][A-Za-z0-9_]*' | sort -u > "$lists/names"
grep -rhoE 'add_subcommand\("[a-z-]+|command\("[a-z-]+' src/cli | sed 's/.*"//' | sort -u > "$lists/subcommands"
grep -rhoE --include='*.cpp' --include='*.h' -e '--[a-z][a-z-]+' src/cli | sort -u > "$lists/options"
while read -r document; do
  folder=$(dirname "$document")
  while read -r target; do
    path=${target%%#*}
    [[ -z $path || $path == *://* || -e $folder/$path ]] || missing "$document" "link to $target"
  done < <(grep -oE '\]\([^)[:space:]]+\)' "$document" | sed -E 's/^\]\((.*)\)$/\1/')
  # Commands in indented blocks name files of the user.
  grep -v '^    ' "$document" > "$lists/text" || continue
  while read -r path; do
    [[ -e $path || -e src/$path || -e $folder/$path ]] || missing "$document" "$path"
  done < <(grep -oE '`[A-Za-z0-9_./-]+/[A-Za-z0-9_.-]+\.(h|cpp|sh|toml|md|txt|cmake)`' "$lists/text" | tr -d '`')
  while read -r file; do
    missing "$document" "$file"
  done < <(grep -oE '(^|[^A-Za-z0-9_*])[A-Za-z0-9_]+\.(h|cpp)\b' "$lists/text" | grep -oE '[A-Za-z0-9_]+\.(h|cpp)$' |
    grep -v NAME | sort -u | comm -23 - "$lists/files")
  while read -r command; do
    read -r _ name _ <<<"$command"
    if [[ $name == [a-z]* && $name != *.* ]]; then
      grep -qx -- "$name" "$lists/subcommands" || missing "$document" "tuft $name"
    fi
    while read -r option; do
      missing "$document" "option $option of tuft $name"
    done < <(grep -oE '(^| )--[a-z][a-z-]+' <<<"$command" | tr -d ' ' | sort -u | comm -23 - "$lists/options")
  done < <(sed -E ':join; /\\$/{N; s/\\\n//; b join}; s/ # .*//' "$document" |
    grep -oE '(^    |`)tuft( [^`]*)' | grep -vE '^`?tuft( |$)*\.$' | sed -E 's/^(    |`)//' | sort -u)
  while read -r suite; do
    grep -qrE "TEST(_F|_P)?\($suite," tests --include='*.cpp' || missing "$document" "suite $suite"
  done < <(grep -oE "(gtest_filter=|ctest [^\`]*-R )['^]*[A-Z][A-Za-z]+" "$document" | grep -oE '[A-Z][A-Za-z]+$' || true)
  [[ $document == src/*/README.md || $document == src/README.md ]] || continue
  while read -r name file; do
    for place in "$file" "src/$file" "$folder/$file"; do [[ -e $place ]] && break; done
    [[ ! -e $place ]] || grep -qw -- "$name" "$place" || missing "$document" "$name is not in $file"
  done < <(tr '\n' ' ' < "$lists/text" | grep -oE '`[A-Za-z_]+(\([^`]*\))?` \(`?[A-Za-z0-9_./-]+\.(h|cpp)' |
    sed -E 's/^`([A-Za-z_]+).*\(`?([^ ]+)$/\1 \2/' || true)
  while read -r name; do
    missing "$document" "$name"
  done < <(grep -oE '`[A-Za-z_][A-Za-z0-9_:]*(\([^`]*\))?`' "$lists/text" | tr -d '`' | sed -E 's/\(.*//; s/.*:://' |
    grep -E '_|[a-z][A-Z]' | grep -v NAME | sort -u | comm -23 - "$lists/names")
done < <(find README.md src tests samples models -name '*.md' -not -path '*/build/*')
# Comments of headers name in `back quotes` what the code has.
code -print0 | xargs -0 sed 's|//.*||' | grep -ohE '[A-Za-z_][A-Za-z0-9_]*' | sort -u > "$lists/code"
while read -r name; do
  missing "$(grep -rlF --include='*.h' "$name" src | head -1)" "\`$name\` in a comment"
done < <(find src -name '*.h' -print0 | xargs -0 grep -ohE '//.*' | grep -oE '`[A-Za-z_][A-Za-z0-9_:]*(\([^`]*\))?`' | tr -d '`' |
  sed -E 's/\(.*//' | grep -vE '(^|[^:]):([^:]|$)' | sed -E 's/.*:://' | grep -E '_|[a-z][A-Z]' | sort -u | comm -23 - "$lists/code")
# A source that is cited by its key, such as [Huang2018], has an entry in the bibliography, and each entry is cited.
keys='\[[A-Z][A-Za-z]*[A-Za-z][0-9]{4}\]'
while read -r key; do missing src/BIBLIOGRAPHY.md "$key is cited and has no entry"; done < <(
  { code -print0 | xargs -0 grep -ohE "$keys" || true; find src -name README.md -print0 | xargs -0 grep -ohE "$keys"; } |
    sort -u | comm -23 - <(grep -oE "$keys" src/BIBLIOGRAPHY.md | sort -u))
while IFS=: read -r file _ text; do missing "$file" "a source cited by name, not by key: $text"; done < <(
  grep -rnoE --include='*.h' --include='*.cpp' '[A-Z][^ ()]+ (and [A-Z][^ ()]+|et al\.),? \(?(19|20)[0-9]{2}\b' src || true)
# The table of modules in src/README.md names the folders of each.
folders_named() { grep -oE '`[a-z]+`' <<<"$1" | tr -d '`' | grep -vx "$2" | sort || true; }
folders_there() {
  find "src/$1" -mindepth 2 \( -name '*.h' -o -name '*.cpp' \) | sed -E "s|^src/$1/([^/]*)/.*|\1|" | sort -u
}
while IFS='|' read -r _ _ module folders _; do
  module=$(grep -oE '`[a-z]+`' <<<"$module" | head -1 | tr -d '`')
  while read -r folder; do
    missing src/README.md "src/$module/$folder stands only in the table of modules or only in the tree"
  done < <(comm -3 <(folders_named "$folders" "$module") <(folders_there "$module") | tr -d '\t')
done < <(grep -E '^\| [0-9] \|' src/README.md)
exit $bad
