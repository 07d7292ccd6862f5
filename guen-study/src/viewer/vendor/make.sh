#!/usr/bin/env bash
# Makes three.min.js anew from the published package; needs npm and a network. Changes of version: here and in README.md.
set -euo pipefail
here="$(cd "$(dirname "$0")" && pwd)"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
cd "$work"
echo '{"private": true}' > package.json
npm install --no-audit --no-fund --ignore-scripts three@0.187.0 esbuild@0.28.2
node node_modules/esbuild/install.js
cp "$here/entry.js" .
{ printf '/*!\nthree.js 0.187.0, https://threejs.org\n\n'; cat node_modules/three/LICENSE; printf '*/\n'; } > license.txt
npx esbuild entry.js --bundle --minify --format=iife --global-name=THREE --target=es2020 --banner:js="$(cat license.txt)" --outfile=three.min.js
cp three.min.js "$here/three.min.js"
cp node_modules/three/LICENSE "$here/LICENSE-three"
cmp "$here/three.min.js" three.min.js && sha256sum "$here/three.min.js"
