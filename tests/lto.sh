#!/bin/bash
# Everything compiled for link-time optimisation and linked once: the linker then sees what single files cannot, two
# types, functions or variables of one name that are not the same. Any such is an error. Nothing is run.
#
#   tests/lto.sh
#
# Builds in build-lto/, by GCC.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
exec </dev/null

cmake --preset lto --log-level=WARNING "$@"
cmake --build build-lto -j "$(nproc)"
