#!/usr/bin/env bash
# Fails when a file in src/ includes a folder that does not lie below its own, lies in a folder without a place in the
# order or with more than 25 sources, or includes a third-party header outside the module that may use it.
set -u
src=$1
# The order of all folders, lowest first. Folders of one line do not include each other.
order='
core
core/geometry core/text
core/system
core/files
core/manual
mesh brush/rod
brush/rod/coupled
mesh/read brush/state
brush/preset
brush/papers/space
mesh/repair mesh/query brush/papers/macro
brush/papers
brush/tuft/shape
atlas brush/tuft
brush/surface
atlas/seams brush/calibration
atlas/flatten
atlas/pack
atlas/charts
atlas/unwrap atlas/texels contact
haptic/device
haptic
footprint/outline
footprint/stamp
ink
ink/spectra
ink/colour
ink/canvas
ink/composite ink/exchange ink/texels
ink/film/tile
ink/film
decal/panels
decal
stroke/journal/entry
stroke/journal
stroke/gesture
stroke/placement
stroke/drawing stroke/surface stroke/pointer
stroke/contact
stroke/deposit
stroke/session
stroke/layers
stroke/painting
stroke/document
motion
io/font io/image io/package render/brush render/gl
io/scene
io/gltf io/import
io/model io/motion render/picture
io/strokes
io/svg/style
io/svg
io/export io/project
io/sheet
pictures
writer/glyphs
writer/gesture
writer/copy writer/fit writer/layout
writer/text
variants
cli/arguments
cli/steps
cli/bench cli/commands cli/device
cli app/input app/text
app/view
app/document/pictures
app/document
app/work
app/paint
app/widgets
app/state
app/session
app/dialogs app/panels
app/tools
app/studio
app/script
app
'
declare -A level
n=0
while read -r line; do
  n=$((n + 1))
  for folder in $line; do level[$folder]=$n; done
done <<<"$order"
bad=0
complain() { echo "$1"; bad=1; }
while read -r folder; do
  [ -n "${level[$folder]:-}" ] || complain "src/$folder has no place in the order of folders"
done < <(cd "$src" && find . -name '*.h' -o -name '*.cpp' | sed -E 's#^\./##; s#/[^/]*$##' | sort -u)
while read -r n folder; do
  [ "$n" -le 25 ] || complain "src/$folder has $n sources: more than 25 are divided by what they do"
done < <(cd "$src" && find . -name '*.h' -o -name '*.cpp' | sed -E 's#^\./##; s#/[^/]*$##' | sort | uniq -c)
# One process for all: a shell would start one for each of thousands of lines.
while read -r complaint; do complain "$complaint"; done < <(
  for folder in "${!level[@]}"; do echo "$folder ${level[$folder]}"; done | awk -v src="$src/" '
    NR == FNR { level[$1] = $2; next }
    { file = $0; sub(/:.*/, "", file); line = substr($0, length(file) + 2)
      own = substr(file, length(src) + 1); sub(/\/[^\/]*$/, "", own)
      target = line; sub(/^#include "/, "", target); sub(/".*/, "", target); sub(/\/[^\/]*$/, "", target)
      if (target != own && target in level && level[target] >= (own in level ? level[own] : 99))
        print file ": " line ": " own " must not include " target }' - <(
    grep -rE --include='*.h' --include='*.cpp' '^#include "[a-z_]+/' "$src"))
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
wall 'OpenImageIO|SQLiteCpp|sqlite3|tiny_gltf|zlib|png\.h|assimp' 'io/*.cpp'
wall '[A-Za-z0-9_]+\.hxx' 'io/import/import_cad.cpp' 'io/import/cad_faces.*'
wall 'draco/' 'io/gltf/draco_module.cpp'
wall 'OpenColorIO' 'ink/spectra/colour_module.cpp'
wall 'meshoptimizer' 'io/gltf/*.cpp' 'mesh/repair/*.cpp'
wall 'pugixml' 'io/*.cpp' 'writer/glyphs/*.cpp'
wall 'ft2build|hb|fontconfig' 'io/font/*.cpp'
wall 'podofo' 'io/sheet/*.cpp'
wall 'GL/|epoxy|EGL' 'render/*' 'app/*'
wall 'GLFW|imgui' 'app/*'
exit $bad
