#!/bin/bash
# Runs the unit tests of the product for 64-bit ARM by qemu, on a Debian 12 of x86-64. As root.
#
#   tests/arm.sh [ROOT [FILTER]]     ROOT: the Debian of arm64 that tools/arm.sh makes; FILTER: of GoogleTest (default: *)
#
# Builds in build-arm64-tests/, for half an hour on two cores the first time.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
root=${1:-/var/tmp/sparselens-roots/arm64} filter=${2:-*}
[ -s "$root/etc/os-release" ] || { echo "arm.sh: $root is not a Debian: tools/arm.sh makes it" >&2; exit 1; }
chroot "$root" apt-get install -y -q --no-install-recommends libgtest-dev >/dev/null
export QEMU_LD_PREFIX=$root # what the build runs finds the libraries of ROOT
cmake -S . -B build-arm64-tests --preset release --toolchain "$PWD/cmake/Arm64.cmake" -DSPARSELENS_SYSROOT="$root" --log-level=WARNING \
    -DSPARSELENS_{BENCHMARKS,PYTHON,LAB,GPU,BUNDLE}=OFF -DSPARSELENS_TESTS=ON
cmake --build build-arm64-tests -j "$(nproc)" --target sparselens-tests
cd build-arm64-tests/tests
shards=$(nproc) failed=0
for ((i = 0; i < shards; ++i)); do
    GTEST_TOTAL_SHARDS=$shards GTEST_SHARD_INDEX=$i qemu-aarch64-static -L "$root" ../bin/sparselens-tests --gtest_brief --gtest_filter="$filter" >"arm.$i.log" 2>&1 &
done
wait
for ((i = 0; i < shards; ++i)); do
    grep -E '^\[( +PASSED +| +FAILED +)\]' "arm.$i.log" || failed=1
    ! grep -q '^\[  FAILED' "arm.$i.log" || failed=1
done
exit $failed
