#!/usr/bin/env bash
# The page of a report in a browser without a screen: no message on its console, and both colour schemes draw something of their own.
#
#   report_page.sh TESSERA [KEEP_FOLDER]
#
# With KEEP_FOLDER the screenshots stay there, to be looked at. Exit code 77: Chromium, ImageMagick or a Vulkan device is missing.
set -euo pipefail

tessera=${1:?usage: $0 TESSERA [KEEP_FOLDER]}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
browser=$(command -v chromium || command -v chromium-browser || true)
[[ -n $browser ]] && command -v convert > /dev/null || { echo "chromium (thirdparty/setup.sh --all) or ImageMagick is missing"; exit 77; }

code=0
"$tessera" report builtin:quad --size 96x64 --rates 16,4 --metrics edge,detail --frames 2 --raster auto --measure-left-out off --max-error-px 2 --quiet \
	-o "$folder/report" || code=$?
(( code == 4 )) && exit 77
(( code == 0 )) || exit "$code"

# Screenshot of $1 in scheme $2 (0 dark, 1 light) to $3.
shoot()
{
	timeout 120 "$browser" --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --hide-scrollbars --user-data-dir="$folder/browser" \
		--enable-logging=stderr --blink-settings=preferredColorScheme="$2" --window-size=1100,2600 --virtual-time-budget=3000 \
		--screenshot="$3" "file://$1" 2> "$folder/browser.log" > /dev/null
	if grep CONSOLE "$folder/browser.log"
	then
		echo "the page has messages on its console"
		return 1
	fi
	[[ -s $3 ]]
}

shoot "$folder/report/report.html" 1 "$folder/light.png"
shoot "$folder/report/report.html" 0 "$folder/dark.png"
if [[ -n ${2:-} ]]
then
	mkdir -p "$2"
	cp "$folder"/{light,dark}.png "$2"
fi
mean() { convert "$1" -colorspace Gray -format '%[fx:mean]' info:; }
deviation() { convert "$1" -colorspace Gray -format '%[fx:standard_deviation]' info:; }
awk -v light="$(mean "$folder/light.png")" -v dark="$(mean "$folder/dark.png")" -v a="$(deviation "$folder/light.png")" -v b="$(deviation "$folder/dark.png")" '
	BEGIN {
		printf "brightness: light %.3f, dark %.3f; deviation %.3f and %.3f\n", light, dark, a, b
		exit !(light > 0.7 && dark < 0.35 && a > 0.03 && b > 0.03)
	}'
