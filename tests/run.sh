#!/bin/bash
# Installs what is missing, builds with warnings as errors and runs every test; fails, too, where a test left out what
# tests/allowed-skips.txt does not name. Takes no arguments; works from any folder; shares build/ with tools/demo.sh.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
exec </dev/null

tools/install-deps.sh build demo gpu test
cmake --preset release --log-level=WARNING -DSPARSELENS_TESTS=ON -DSPARSELENS_BENCHMARKS=ON \
    -DSPARSELENS_LAB=ON -DSPARSELENS_GPU=ON -DSPARSELENS_PYTHON=ON
cmake --build build -j "$(nproc)"
# One more at once than there are cores, as some mostly wait. The limit is for what never ends: ten times what the longest test
# takes on two cores, and less than half of what continuous integration has.
code=0
ctest --test-dir build --output-on-failure --timeout 1500 -j "$(($(nproc) + 1))" | tee build/tests.log || code=$?
tests/skips.sh build || code=1
exit $code
