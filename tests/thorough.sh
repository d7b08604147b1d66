#!/bin/bash
# Tests that take too long for the normal tests and continuous integration; for a release, or after a large change.
# Takes hours.
#
#   tests/thorough.sh [ROW...]     all, or those of: lto no-lab no-gpu no-python shared asan tsan mutations fuzz
#
# lto: differences between files with one name (tests/lto.sh); no-lab: everything without Embree; no-gpu, no-python,
# shared: every test without the kernels for GPUs, without the Python module, with a shared library; asan: the unit
# tests under AddressSanitizer and UndefinedBehaviorSanitizer; tsan: the tests under ThreadSanitizer; mutations: every
# deliberate fault; fuzz: a minute of each target. Prints a table at the end; each row's output is in
# build-thorough/ROW.log. Exits with 1 if one fails.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
exec </dev/null
rows=(lto no-lab no-gpu no-python shared asan tsan mutations fuzz)
for row; do [[ " ${rows[*]} " == *" $row "* ]] || { echo "thorough.sh: no row $row (${rows[*]})" >&2; exit 2; }; done
[ $# -eq 0 ] || rows=("$@")

# with OPTION...: builds all rows in one folder, so that a row compiles only what its options change.
with() {
    cmake --preset release -B build-thorough/build --log-level=WARNING -DBUILD_SHARED_LIBS=OFF -DSPARSELENS_LAB=ON \
        -DSPARSELENS_GPU=ON -DSPARSELENS_PYTHON=ON "$@" &&
        cmake --build build-thorough/build -j "$(nproc)" &&
        ctest --test-dir build-thorough/build --output-on-failure --timeout 3000 -j 2 &&
        tests/skips.sh build-thorough/build
}
run() {
    case $1 in
    lto) tests/lto.sh ;;
    no-lab) bash tests/scripts/no-lab.sh all ;;
    no-gpu) with -DSPARSELENS_GPU=OFF ;;
    no-python) with -DSPARSELENS_PYTHON=OFF ;;
    shared) with -DBUILD_SHARED_LIBS=ON ;;
    asan) tests/sanitizers.sh --units asan ;;
    tsan) tests/sanitizers.sh tsan ;;
    mutations) tests/mutations.sh ;;
    fuzz) tests/fuzz.sh 60 ;;
    esac
}

tools/install-deps.sh build demo gpu test lint || exit 1
mkdir -p build-thorough
table=() code=0
for row in "${rows[@]}"; do
    echo "== $row"
    begun=$SECONDS result=passed
    run "$row" >"build-thorough/$row.log" 2>&1 || result="FAILED with $?: build-thorough/$row.log" code=1
    [ "$result" = passed ] || tail -n 20 "build-thorough/$row.log"
    table+=("$(printf '%-10s %4d min  %s' "$row" $(((SECONDS - begun) / 60)) "$result")")
done
printf '%s\n' "${table[@]}"
exit $code
