#!/usr/bin/env bash
# Fails when a file in src/ includes a module, or a part of the studio, that does not lie below its own, or a
# third-party header outside the module that may use it.
set -u
src=$1
declare -A level=([core]=0 [mesh]=1 [brush]=1 [atlas]=2 [contact]=2 [footprint]=3 [ink]=4 [stroke]=5 [io]=6 [render]=6 [cli]=7 [app]=7)
bad=0
complain() { echo "$1"; bad=1; }
while IFS=: read -r file line; do
  module=${file#"$src"/}; module=${module%%/*}
  target=$(sed -E 's/.*"([a-z_]+)\/.*/\1/' <<<"$line")
  [ -n "${level[$module]:-}" ] || { complain "$file: lies in no known module"; continue; }
  if [ "$target" != "$module" ] && [ -n "${level[$target]:-}" ] && [ "${level[$target]}" -ge "${level[$module]}" ]; then
    complain "$file: $line: $module (level ${level[$module]}) must not include $target (level ${level[$target]})"
  fi
done < <(grep -rE --include='*.h' --include='*.cpp' '^#include "[a-z_]+/' "$src")
# Within the studio: hand and keys, what is seen, what is kept, and over them the panels.
declare -A storey=([input]=0 [view]=1 [document]=2)
while IFS=: read -r file line; do
  own=$(sed -E 's#.*/app/([a-z]+)/.*#\1#' <<<"$file")
  target=$(sed -E 's#.*"app/([a-z_]+)[/.].*#\1#' <<<"$line")
  [ -n "${storey[$own]:-}" ] || continue
  [ "${storey[$target]:-9}" -le "${storey[$own]}" ] || complain "$file: $line: app/$own must not include app/$target"
done < <(grep -rE --include='*.h' --include='*.cpp' '^#include "app/' "$src/app")
# wall PATTERN ALLOWED...: headers that match may only be included by files that match one of ALLOWED.
wall() {
  local pattern=$1; shift
  while IFS=: read -r file line; do
    local rel=${file#"$src"/} ok=0
    for allowed in "$@"; do [[ $rel == $allowed ]] && ok=1; done
    [ $ok = 1 ] || complain "$file: $line: not allowed here (only in: $*)"
  done < <(grep -rE --include='*.h' --include='*.cpp' "^#include <($pattern)" "$src")
}
wall 'OpenMesh' 'mesh/*.cpp'
wall 'CGAL' '*.cpp'
wall 'embree3' '*.cpp'
wall 'OpenImageIO|SQLiteCpp|sqlite3|tiny_gltf|pugixml|zlib|assimp' 'io/*.cpp'
wall 'GL/|epoxy|EGL' 'render/*' 'app/*'
wall 'GLFW|imgui' 'app/*'
exit $bad
