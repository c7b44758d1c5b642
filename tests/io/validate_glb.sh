#!/usr/bin/env bash
# usage: validate_glb.sh NODE_FOLDER [--make PROGRAM FOLDER | FILE...]
# Runs the Khronos glTF validator (npm gltf-validator, installed below NODE_FOLDER) over the
# files, or over all that PROGRAM writes into FOLDER. Any error, warning or hint fails.
# Exit 77, aloud, when node or the validator is absent.
set -euo pipefail
node_folder=$1
shift
if ! command -v node >/dev/null || [ ! -d "$node_folder/node_modules/gltf-validator" ]; then
  echo "SKIPPED: node or gltf-validator is not installed (npm install --prefix $node_folder gltf-validator)"
  exit 77
fi
if [ "${1:-}" = --make ]; then
  rm -rf "$3"
  "$2" "$3"
  set -- "$3"/*.glb "$3"/*.gltf
fi
NODE_PATH=$node_folder/node_modules node -e '
const fs = require("fs"), path = require("path");
const validator = require("gltf-validator");
(async () => {
  let bad = 0;
  for (const file of process.argv.slice(1)) {
    const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), {
      uri: path.basename(file),
      externalResourceFunction: uri => fs.promises.readFile(
        path.join(path.dirname(file), decodeURIComponent(uri))).then(b => new Uint8Array(b)),
    });
    const i = report.issues;
    console.log(`${file}: ${i.numErrors} errors, ${i.numWarnings} warnings, ${i.numHints} hints, ` +
                `${i.numInfos} infos; ${report.info.totalTriangleCount} triangles`);
    for (const m of i.messages) console.log(`  ${m.code} at ${m.pointer}: ${m.message}`);
    bad += i.numErrors + i.numWarnings + i.numHints;
  }
  process.exit(bad ? 1 : 0);
})().catch(e => { console.error(String(e)); process.exit(1); });
' "$@"
