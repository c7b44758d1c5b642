#!/usr/bin/env bash
# Manual pages and completions name every command and option that --help names, and the shells take them.
# manual.sh TUFT TUFT_STUDIO|'' SOURCE
set -euo pipefail
tuft=$1 studio=$2 export_data=$3
export TUFT_DATA=$export_data
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
bad=0
fail() { echo "FAILED: $*"; bad=1; }

"$tuft" --reference "$work"
[ -z "$studio" ] || "$studio" --reference "$work"

plain() { sed -e 's/\\f[BIR]//g' -e 's/\\-/-/g' -e 's/\\&//g' "$1"; }
subcommands() { "$@" --help | sed -n '/^Subcommands:/,/^$/p' | grep -oE '^  [a-z][a-z-]*' | tr -d ' ' || true; }
# named PAGE PROGRAM [COMMAND]: every option of the help of a command and its subcommands is in the page and in both
# completions.
named() {
  local page=$1 option options sub
  shift
  options=$({
    "$@" --help
    [ $# = 1 ] || for sub in $(subcommands "$@"); do "$@" "$sub" --help; done
  } | grep -oE '^  +-[^ ]+' | tr ',' '\n' | grep -oE '\-\-?[a-z][a-z-]*' | sort -u)
  local text
  text=$(plain "$work/man1/$page.1")
  [ "$(wc -w <<<"$options")" -ge 3 ] || fail "$* --help names only: $options"
  for option in $options; do
    grep -qE -- "(^|[ ,])$option(\$|[ ,])" <<<"$text" || fail "$page.1 does not name $option"
    grep -q -- "$option" "$work/bash/${page%%-[a-rt-z]*}" || fail "the bash completion does not name $option of $page"
    grep -q -- "$option" "$work/zsh/_${page%%-[a-rt-z]*}" || fail "the zsh completion does not name $option of $page"
  done
}
commands=$(subcommands "$tuft")
[ "$(wc -w <<<"$commands")" -ge 10 ] || fail "commands: $commands"
named tuft "$tuft"
for command in $commands; do named "tuft-$command" "$tuft" "$command"; done
[ -z "$studio" ] || named tuft-studio "$studio"
[ "$(find "$work/man1" -name 'tuft-*.1' ! -name tuft-studio.1 | wc -l)" = "$(wc -w <<<"$commands")" ] || fail "one page a command"

for page in "$work"/man1/*.1; do
  if command -v mandoc >/dev/null; then
    mandoc -Tlint -W warning "$page" || fail "$page"
  elif command -v groff >/dev/null; then
    [ -z "$(groff -man -ww -z "$page" 2>&1)" ] || fail "$page"
  fi
done

# completes "WORDS" WANTED...: bash offers these for the last word, among others that begin like it.
completes() {
  local offered
  offered=$(bash -c 'set -f; . "$1"; . "$2" 2>/dev/null; read -ra COMP_WORDS <<<"$3"; [[ $3 != *" " ]] || COMP_WORDS+=("")
    COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); set +f; "_${COMP_WORDS[0]//-/_}"; printf "%s\n" "${COMPREPLY[@]}"' _ \
    "$work/bash/${1%% *}" /dev/null "$1" 2>&1)
  shift
  for wanted in "$@"; do
    if [[ $wanted == !* ]]; then ! grep -qxF -- "${wanted#!}" <<<"$offered" || fail "'$words' offers ${wanted#!}"
    else grep -qxF -- "$wanted" <<<"$offered" || fail "'$words' does not offer $wanted but: $(tr '\n' ' ' <<<"$offered")"
    fi
  done
}
cd "$work"
touch bowl.ply part.step line.inkml leaf.svg brush.toml picture.png
mkdir folder
while IFS='|' read -r words wanted; do
  # shellcheck disable=SC2086  # several words
  completes "$words" $wanted
done <<'CASES'
tuft |paint inspect unwrap replay export render brush mask !calibrate !--version
tuft pa|paint !inspect
tuft --v|--version
tuft paint --sp|--spine !--seams
tuft paint --spine |rod table
tuft paint --spine = ta|table !rod
tuft paint --brush go|goat-small goat-large !wolf-small
tuft paint --brush |wolf-medium brush.toml !carbon !picture.png
tuft paint --ink |carbon indigo !wolf-medium
tuft paint --substrate |porcelain bisque
tuft paint |bowl.ply part.step folder !line.inkml !picture.png
tuft paint bowl.ply --strokes |line.inkml leaf.svg folder !bowl.ply
tuft write bowl.ply --curve |line.inkml folder !bowl.ply
tuft paint bowl.ply --strokes line.inkml --export |folder !picture.png
tuft paint bowl.ply --preview |picture.png !bowl.ply
tuft layer x.tuft |add remove opacity !rod
tuft brush |calibrate match wolf-medium
tuft brush wolf-medium calibrate --|--output !--picture
tuft export x.tuft --bits |8 16
CASES
[ -z "$studio" ] || { words="tuft-studio --"; completes "$words" --script --headless; }

if command -v zsh >/dev/null; then
  for file in "$work"/zsh/_*; do zsh -n "$file" || fail "$file"; done
else
  echo "zsh is not installed: its completion was not tried"
fi
exit $bad
