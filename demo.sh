#!/usr/bin/env bash
# Sets up, builds and draws the built-in scene: one picture and its statistics in out/.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

say() { echo "demo: $*"; }

say "1/3 checking what is installed (thirdparty/setup.sh)"
thirdparty/setup.sh

say "2/3 building build/release/tessera"
cmake --preset release --log-level=WARNING > /dev/null
cmake --build --preset release --target tessera tessera_shaders

say "3/3 drawing the built-in scene"
mkdir -p out
build/release/tessera render -o out/demo.png --stats out/demo.json

say "picture: $PWD/out/demo.png"
say "stats:   $PWD/out/demo.json"
say "next:    build/release/tessera render model.gltf -o picture.png   (or --help)"
