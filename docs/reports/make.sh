#!/usr/bin/env bash
# Makes the example reports anew: sphere, terrain, the asteroid of Debian's glmark2-data, and a shaderball when it is given (it is not part of this
# repository). Run in the repository's root. Needs glmark2-data and assimp-utils (thirdparty/setup.sh --all), or OUT_FOLDER/asteroid.glb and
# asteroid-high.glb made with them and HEIGHT_MAPS, the folder of its height map. From the environment also SIZE, FRAMES and WARMUP.
#
#   docs/reports/make.sh TESSERA OUT_FOLDER [SHADERBALL.glb HEIGHT_MAP.png]
set -euo pipefail

tessera=${1:?usage: $0 TESSERA OUT_FOLDER [SHADERBALL.glb HEIGHT_MAP.png]}
out=${2:?usage: $0 TESSERA OUT_FOLDER [SHADERBALL.glb HEIGHT_MAP.png]}
common=(--size "${SIZE:-960x540}" --metrics edge,detail --raster soft --frames "${FRAMES:-32}" --warmup "${WARMUP:-16}" --max-error-px 0.5)
mkdir -p "$out"

"$tessera" report bench/scenes/sphere.gltf --rates 4,2,1,0.5,0.25 "${common[@]}" -o "$out/sphere"
"$tessera" report bench/scenes/terrain.gltf --rates 8,4,2,1,0.5 "${common[@]}" -o "$out/terrain"
# The model, and the one that its height map was made from: the two .3ds have one coordinate system, and assimp turns both alike.
[[ -e $out/asteroid.glb ]] || assimp export /usr/share/glmark2/models/asteroid-low.3ds "$out/asteroid.glb" -f glb2 > /dev/null
[[ -e $out/asteroid-high.glb ]] || assimp export /usr/share/glmark2/models/asteroid-high.3ds "$out/asteroid-high.glb" -f glb2 > /dev/null
# Factor and offset: README.md.
"$tessera" report "$out/asteroid.glb" --displacement "${HEIGHT_MAPS:-/usr/share/glmark2/textures}/asteroid-height-map.png:0.0224:-0.0131" --rates 16,8,4,2,1 \
	--original "$out/asteroid-high.glb" "${common[@]}" -o "$out/asteroid"
[[ -z ${3:-} ]] || "$tessera" report "$3" --displacement "$4:0.02" --rates 8,4,2,1 "${common[@]}" -o "$out/shaderball"
