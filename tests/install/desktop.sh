#!/usr/bin/env bash
# What desktops read of tuft-studio is sound: desktop.sh SOURCE BUILD
set -euo pipefail
desktop=$1/src/app/desktop metainfo=$2/package/org.tuft.studio.metainfo.xml
tried=0
try() { # try PROGRAM ARGUMENTS...: skipped where it is not installed
  command -v "$1" >/dev/null || { echo "$1 is not installed"; return 0; }
  tried=1
  "$@"
}
try appstreamcli validate --no-net "$metainfo"
try desktop-file-validate "$desktop/tuft-studio.desktop"
[ $tried = 1 ] || exit 77
type=$(sed -n 's/.*mime-type type="\([^"]*\)".*/\1/p' "$desktop/tuft-studio.xml")
grep -q "^MimeType=\(.*;\)\?$type;" "$desktop/tuft-studio.desktop" || { echo "the desktop file does not open $type"; exit 1; }
grep -q "<mediatype>$type</mediatype>" "$metainfo" || { echo "the AppStream data does not name $type"; exit 1; }
for icon in "$desktop"/tuft-studio-*.png; do  # width and height of a PNG are its bytes 16 to 23
  size=${icon##*-} size=${size%.png}
  read -r width height < <(od -An -j16 -N8 -tu4 --endian=big "$icon")
  [ "$width $height" = "$size $size" ] || { echo "$icon is $width x $height"; exit 1; }
done
