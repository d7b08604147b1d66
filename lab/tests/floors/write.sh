#!/bin/bash
# Writes the table of floors.h: what sparselens-lab-tests, built from the current code, measures now.
#
#   lab/tests/floors/write.sh BIN_DIR
set -euo pipefail
tests=$(realpath "$1")/sparselens-lab-tests
cd "$(dirname "${BASH_SOURCE[0]}")"
out=$(mktemp)
trap 'rm "$out"' EXIT
# A test that fails by its figures has measured them; anything else that goes wrong has not.
"$tests" --gtest_filter='*Floors*' >"$out" || [ $? -eq 1 ]
rows=$(grep '^    {"' "$out")
[ "$(wc -l <<<"$rows")" -ge "$(grep -c '^    {"' floors.h)" ] || {
    echo "write.sh: floors.h has pictures that no test measured now: mend the test, or remove their lines" >&2
    exit 1
}
table=$(sed -e '/ floors\[\] = {$/,/^};$/{//!d}' -e '/ floors\[\] = {$/r /dev/stdin' floors.h <<<"$rows")
diff floors.h - <<<"$table" || echo "A figure falls only for a reason in docs/tolerances.md, section 7."
echo "$table" >floors.h
