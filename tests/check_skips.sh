#!/usr/bin/env bash
# Compares the tests that a run skipped with those that may be skipped (tests/expected_skips).
#   tests/check_skips.sh RESULTS.xml...     JUnit files that ctest wrote
# Exit code 1 when a skipped test is not expected, or an expectation has no reason.
set -euo pipefail

(( $# )) || { echo "usage: tests/check_skips.sh RESULTS.xml..." >&2; exit 2; }

patterns=() reasons=()
while read -r pattern reason
do
	[[ -z $pattern || $pattern == '#'* ]] && continue
	[[ -n $reason ]] || { echo "tests/expected_skips: '$pattern' has no reason" >&2; exit 1; }
	patterns+=("$pattern") reasons+=("$reason")
done < "$(dirname "${BASH_SOURCE[0]}")/expected_skips"

# Prints why the test $1 may be skipped; fails when no line names it.
reasonFor()
{
	local i
	for i in "${!patterns[@]}"
	do
		# shellcheck disable=SC2053
		[[ $1 == ${patterns[i]} ]] && { echo "${reasons[i]}"; return; }
	done
	return 1
}

skippedTests()
{
	sed -n 's/.*<testcase name="\([^"]*\)".* status="\(notrun\|disabled\)".*/\1/p' "$1" |
		sed 's/&lt;/</g; s/&gt;/>/g; s/&quot;/"/g; s/&apos;/'"'"'/g; s/&amp;/\&/g'
}

unexpected=0 expected=0
for results in "$@"
do
	[[ -r $results ]] || { echo "check_skips: no file $results" >&2; exit 2; }
	while read -r name
	do
		if reason=$(reasonFor "$name")
		then
			echo "skipped as expected: $name ($reason)"
			expected=$((expected + 1))
		else
			echo "skipped, but not named in tests/expected_skips: $name" >&2
			unexpected=$((unexpected + 1))
		fi
	done < <(skippedTests "$results")
done
echo "skipped tests: $expected expected, $unexpected not expected"
(( unexpected == 0 ))
