#!/bin/bash
# Installs missing packages, builds with warnings as errors and runs the tests; also fails if a test left out something
# that tests/allowed-skips.txt does not name. Works from any folder; shares build/ with tools/demo.sh.
#
#   tests/run.sh            the tests that everybody runs: five minutes on two cores
#   tests/run.sh --slow     the others, labelled `slow`: browser, packages, farms, rivals, damaged files, all scenes
#   tests/run.sh --all      both
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
exec </dev/null

case ${1-} in
'') chosen=(-LE '^slow$') ;;
--slow) chosen=(-L '^slow$') ;;
--all) chosen=() ;;
*) echo "run.sh: unknown option $1 (--slow, --all)" >&2 && exit 2 ;;
esac

tools/install-deps.sh build demo gpu test
cmake --preset release --log-level=WARNING -DSPARSELENS_TESTS=ON -DSPARSELENS_BENCHMARKS=ON \
    -DSPARSELENS_LAB=ON -DSPARSELENS_GPU=ON -DSPARSELENS_PYTHON=ON -DSPARSELENS_BUNDLE=ON
cmake --build build -j "$(nproc)"
# One process more than there are cores, because some mostly wait. The limit stops tests that never end: it is ten times
# the longest test on two cores, and less than half of the time of continuous integration.
code=0
ctest --test-dir build "${chosen[@]}" --output-on-failure --timeout 1500 -j "$(($(nproc) + 1))" | tee build/tests.log || code=$?
tests/skips.sh build || code=1
exit $code
