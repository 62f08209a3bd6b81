#!/usr/bin/env bash
# Which metric has the best front on this device? Runs `tessera report` over built-in scenes with several metrics and prints, per scene, what each
# metric takes for what `edge` takes at equal error: GPU time and micro-triangles; then the geometric mean over the scenes, and which metric wins.
#
#   bench/metric_fronts.sh TESSERA OUT_FOLDER [option of report ...]
#
# From the environment: SCENES, METRICS (first: what the others are compared with), RATES, SIZE. Options go to every report (not
# --quiet); the folder keeps the reports.
set -euo pipefail

tessera=${1:?usage: $0 TESSERA OUT_FOLDER [option ...]}
out=${2:?usage: $0 TESSERA OUT_FOLDER [option ...]}
shift 2
scenes=${SCENES:-planet terrain bricks showcase:100}
metrics=${METRICS:-edge,detail,displaced}
rates=${RATES:-8,4,2}
size=${SIZE:-1920x1080}

mkdir -p "$out"
: > "$out/fronts.txt"
for scene in $scenes
do
	folder=$out/${scene%%:*}
	started=$SECONDS
	"$tessera" report "builtin:$scene" --size "$size" --rates "$rates" --metrics "$metrics" --raster auto --frames 48 --warmup 16 \
		--measure-left-out off -o "$folder" "$@" 2> "$folder.log" || { tail -n 1 "$folder.log" >&2; exit 1; }
	{ grep -oE '[0-9]+x[0-9]+, [a-z]+: [a-z]+ takes .*' "$folder.log" || echo "no errors in common"; } | sed "s/^/$scene: /" | tee -a "$out/fronts.txt"
	echo "$scene: $((SECONDS - started)) s"
done

# "...: METRIC takes R times the KIND of BASE at equal error (...)"
awk -v baseline="${metrics%%,*}" '
	match($0, /: [a-z]+ takes [0-9.]+ times the (GPU time|micro-triangles) of/) {
		split(substr($0, RSTART + 2, RLENGTH - 2), word, " ")
		kind = word[6] == "GPU" ? "GPU time" : "micro-triangles"
		sum[word[1], kind] += log(word[3])
		count[word[1], kind]++
		metrics[word[1]]
	}
	END {
		best = baseline
		least = 1
		for (metric in metrics)
		{
			if (!count[metric, "GPU time"])
				continue
			compared = 1
			time = exp(sum[metric, "GPU time"] / count[metric, "GPU time"])
			printf "%s: %.3f times the GPU time of %s at equal error, %.3f times its micro-triangles (geometric means over %d scenes)\n",
				metric, time, baseline, exp(sum[metric, "micro-triangles"] / count[metric, "micro-triangles"]), count[metric, "GPU time"]
			if (time < least)
			{
				least = time
				best = metric
			}
		}
		printf "best front: %s\n", compared ? best : "not told: no errors in common, or times too unsteady"
	}' "$out/fronts.txt" | tee -a "$out/fronts.txt"
