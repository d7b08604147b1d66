#!/bin/bash
# Installs what is missing, builds with warnings as errors and runs every test. Takes no arguments; works from
# any folder; shares build/ with tools/demo.sh.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
exec </dev/null

tools/install-deps.sh build demo gpu test
cmake --preset release --log-level=WARNING -DSPARSELENS_TESTS=ON -DSPARSELENS_BENCHMARKS=ON
cmake --build build -j "$(nproc)"
ctest --test-dir build --output-on-failure --timeout 300 -j 2
