#!/usr/bin/env bash
# Builds and tests.
#   ./test.sh          set-up, Release build, tests labelled cpu and gpu, skipped tests, formatting
#   ./test.sh --all    also the slow tests, the sanitizer build and its tests, a clang build, and clang-tidy
# GPU tests run on the machine's default Vulkan device; the software driver is one.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

step()
{
	echo "test: [${SECONDS}s] $*"
}
stop() { echo "test: $*" >&2; exit 2; }

# C++ and shared shader sources under version control; outside a checkout, all there are.
sources()
{
	git ls-files -- '*.cpp' '*.h' 2> /dev/null ||
		find src layer shaders tables tests bench include '(' -name '*.cpp' -o -name '*.h' ')' 2> /dev/null || true
}

buildPreset()
{
	cmake --preset "$1" --log-level=WARNING > /dev/null
	cmake --build --preset "$1"
}

checkFormat()
{
	if ! command -v clang-format > /dev/null
	then
		echo "test: clang-format is not installed, formatting not checked (thirdparty/setup.sh --all installs it)"
		return
	fi
	local file wrong=0
	while read -r file
	do
		clang-format --dry-run --Werror "$file" 2> /dev/null && continue
		echo "test: not formatted: $file (run clang-format -i on it)" >&2
		wrong=1
	done < <(sources)
	return $wrong
}

checkTidy()
{
	sources | grep -E '^(src|tables)/.*\.cpp$' | xargs -r -n 4 -P "$(nproc)" clang-tidy --quiet -p build/clang \
		2> >(grep -v 'warnings generated' >&2)
}

all=0
case ${1:-} in
	"") ;;
	--all) all=1 ;;
	*) stop "unknown argument '$1'; usage: ./test.sh [--all]" ;;
esac

step "checking what is installed"
if (( all )); then thirdparty/setup.sh --all; else thirdparty/setup.sh; fi

step "building (preset release)"
buildPreset release

step "running the tests labelled cpu and gpu"
ctest --preset release
results=(build/release/tests.xml)

if (( all ))
then
	step "running the slow tests"
	ctest --preset slow
	[[ -f build/release/tests_slow.xml ]] && results+=(build/release/tests_slow.xml)

	step "building with sanitizers (preset debug-sanitize)"
	buildPreset debug-sanitize
	step "running the tests with sanitizers"
	ctest --preset debug-sanitize
	results+=(build/debug/tests.xml)

	step "building with clang (preset clang)"
	buildPreset clang
	step "running clang-tidy"
	checkTidy
fi

step "checking formatting"
checkFormat

step "checking skipped tests"
tests/check_skips.sh "${results[@]}"
step "all passed"
