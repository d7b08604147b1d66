#!/bin/bash
# Compiles everything for link-time optimisation and links it once: the linker then sees types, functions or variables
# with one name that differ between files. Any such difference is an error. Nothing is run.
#
#   tests/lto.sh
#
# Builds in build-lto/, with GCC.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
exec </dev/null

cmake --preset lto --log-level=WARNING "$@"
cmake --build build-lto -j "$(nproc)"
