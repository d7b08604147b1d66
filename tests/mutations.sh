#!/bin/bash
# Puts deliberate faults in, one at a time, and reports which tests catch each. A fault that no test catches is a gap in
# the tests. tests/mutations.txt lists the faults.
#
#   tests/mutations.sh [NAME...]     all, or those of these names
#   tests/mutations.sh --check       does each fault find its line, exactly one, and its tests? Nothing is built
#
# Works on a copy in build-mutations/; exits with 1 if a fault is not caught.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
exec </dev/null
source=$PWD copy=$PWD/build-mutations
faults=$(grep -vE '^(#|$)' tests/mutations.txt)

wrong=0
complain() {
    echo "tests/mutations.txt: $*"
    wrong=1
}
cut -d '|' -f 1 <<<"$faults" | sort | uniq -d | grep . && complain "names that are taken twice"
suites=$(grep -rhoE 'TEST(_F|_P)?\([A-Za-z]+' tests lab/tests | sed 's/.*(//' | sort -u)
while IFS='|' read -r name file what instead caught; do
    [ -f "$file" ] || { complain "$name: there is no $file"; continue; }
    changed=$(sed "s|$what|$instead|" "$file" | diff "$file" - | grep -c '^<' || true)
    [ "$changed" -eq 1 ] || complain "$name: changes $changed lines of $file, not one"
    [[ ! "$caught" =~ ^([A-Za-z]+)\.\*$ ]] || grep -qx "${BASH_REMATCH[1]}" <<<"$suites" || complain "$name: no tests $caught"
    [[ ! "${instead//\\&/}" == *"&"* ]] || complain "$name: puts what it finds in for a &; write \\&"
done <<<"$faults"
[ $wrong -eq 0 ] || exit 1
[ "${1-}" != --check ] || exit 0

for name; do
    cut -d '|' -f 1 <<<"$faults" | grep -xF -e "$name" >/dev/null || { echo "mutations.sh: no fault is named $name" >&2; exit 2; }
done
[ $# -eq 0 ] || faults=$(while IFS= read -r fault; do [[ " $* " != *" ${fault%%|*} "* ]] || echo "$fault"; done <<<"$faults")

rm -rf "$copy"
mkdir "$copy"
git ls-files -z | xargs -0 cp --parents -t "$copy"
cd "$copy"
cmake --preset release --log-level=WARNING -DSPARSELENS_BENCHMARKS=OFF -DSPARSELENS_WERROR=OFF

# build CAUGHT_BY: builds what those tests need; tests other than the unit tests may need anything.
build() {
    local targets=()
    is_ctest "$1" || targets=(sparselens-tests sparselens-lab-tests)
    ninja -C build -j "$(nproc)" "${targets[@]}" >build.log 2>&1
}
ctests=$(ctest --test-dir build -N | sed -n 's/^ *Test *#[0-9]*: //p')
is_ctest() { [ -n "$1" ] && grep -qxF -e "$1" <<<"$ctests"; }

# failed_units FILTER: the unit tests of that filter that fail. A test that never ends, or ends the others too, counts
# as failed.
failed_units() {
    local code failed tests
    for tests in sparselens-tests sparselens-lab-tests; do
        code=0
        timeout 3000 "build/bin/$tests" --gtest_brief=1 --gtest_filter="$1" >units.log 2>&1 || code=$?
        failed=$(sed -nE 's/^\[  FAILED  \] ([A-Za-z0-9_/.]+).*/\1/p' units.log | sort -u)
        [ $code -eq 0 ] || echo "${failed:-$tests ends with $code}"
    done
}
# failing_tests CAUGHT_BY: the tests that fail. By default the unit tests except those of the ray tracer.
failing_tests() {
    if is_ctest "$1"; then
        ctest --test-dir build -R "^${1//./\\.}\$" >ctest.log 2>&1 || echo "$1"
    else
        failed_units "${1:--Trac*:Render*:Scenes*:Shading*}"
    fi
}
while read -r by; do
    build "$by" || { tail -n 20 build.log; exit 1; }
    [ -z "$(failing_tests "$by")" ] || { echo "tests fail without any fault"; failing_tests "$by"; exit 1; }
done < <(cut -d '|' -f 5 <<<"$faults" | sort -u)

missed=0
while IFS='|' read -r name file what instead by; do
    sed -i "s|$what|$instead|" "$file"
    if ! build "$by"; then
        echo "$name: does not compile"
        tail -n 5 build.log
        missed=$((missed + 1))
    else
        caught=$(failing_tests "$by")
        [ -n "$caught" ] || missed=$((missed + 1))
        echo "$name ($file): ${caught:+$(wc -l <<<"$caught") fail: }$(head -n 4 <<<"${caught:-NOT CAUGHT}" | paste -sd ' ')"
    fi
    cp -p "$source/$file" "$file"
    touch "$file"
done <<<"$faults"
exit $((missed > 0))
