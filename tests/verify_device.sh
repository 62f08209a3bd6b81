#!/usr/bin/env bash
# Every promise on one device: the extreme suite, the built-in scenes, those of the bench, further ones, and ten thousand views of a closed surface.
# Takes minutes on a GPU, about an hour on a software device.
#   tests/verify_device.sh FOLDER [SCENE [OPTION...]]     reports go to FOLDER as text and JSON; SCENE: one more, with its options
# TESSERA=program (build/release/tessera), DEVICE=name or number, LEAKS=views (10000). Exit code 1 when anything is violated.
set -uo pipefail

(( $# )) || { echo "usage: tests/verify_device.sh FOLDER [SCENE [OPTION...]]" >&2; exit 2; }
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
program=${TESSERA:-$root/build/release/tessera}
folder=$1
shift
mkdir -p "$folder"
device=()
[[ -n ${DEVICE:-} ]] && device=(--device "$DEVICE")

failed=0
# check NAME ARGUMENTS...
check()
{
	local name=$1 start=$SECONDS code
	shift
	"$program" verify "$@" "${device[@]}" --quiet --json "$folder/$name.json" > "$folder/$name.txt" 2> "$folder/$name.err"
	code=$?
	printf '%-24s exit code %d, %4d s\n' "$name" $code $(( SECONDS - start ))
	(( code == 0 )) && return
	failed=1
	tail -n 3 "$folder/$name.err"
}

usual=(--size 320x180 --rates 8,2 --cameras 6 --usual-way)
check suite --suite extreme --usual-way
for scene in planet showcase:60 terrain bricks instances:200 quad cube materials
do
	check "${scene%%:*}" "builtin:$scene" "${usual[@]}"
done
for scene in sphere terrain
do
	check "bench_$scene" "$root/bench/scenes/$scene.gltf" "${usual[@]}"
done
(( $# )) && check scene "$@" "${usual[@]}"
check leaks builtin:planet --size 160x90 --rate 6 --leaks "${LEAKS:-10000}"
exit $failed
