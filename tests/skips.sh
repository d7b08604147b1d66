#!/bin/bash
# Checks what the last run of ctest left out: each line must be in tests/allowed-skips.txt.
#
#   tests/skips.sh [BUILD_DIR | LOG]     build; or a log of ctest
#
# A test that is skipped, or skips a part, prints a line "skipped: WHAT". ctest counts it as passed.
set -euo pipefail
allowed=$(dirname "${BASH_SOURCE[0]}")/allowed-skips.txt
log=${1:-build}
[ -f "$log" ] || log=$log/Testing/Temporary/LastTest.log
grep -q '^End testing' "$log" || { echo "skips.sh: ctest did not end ($log)" >&2; exit 1; }

# may TEST WHAT: is it on the list?
may() {
    local test what
    while IFS='|' read -r test what _; do
        # shellcheck disable=SC2053
        [[ $1 == $test && $2 =~ ^$what ]] && return
    done < <(grep -vE '^(#|$)' "$allowed")
    return 1
}

code=0
while IFS='|' read -r test what; do
    if may "$test" "$what"; then
        echo "left out, as it may be: $test: $what"
    else
        echo "left out, but not in tests/allowed-skips.txt: $test: $what"
        code=1
    fi
done < <(awk '/^[0-9]+\/[0-9]+ Testing: / { test = $3 } sub(/^skipped: /, "") { print test "|" $0 }' "$log")
exit $code
