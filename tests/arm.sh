#!/bin/bash
# Runs the unit tests of the product for 64-bit ARM by qemu, on a Debian 12 of x86-64. As root.
#
#   tests/arm.sh [ROOT [FILTER]]     ROOT: the Debian of arm64 that tools/arm.sh makes; FILTER: of GoogleTest (default: all
#                                    but one, as posix_spawn in qemu does not say that a program is missing)
#
# Builds in build-arm64-tests/, for half an hour on two cores the first time.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
root=${1:-/var/tmp/sparselens-roots/arm64} filter=${2:--SystemTest.RunsAProgramWithItsThreeStreams}
[ -s "$root/etc/os-release" ] || { echo "arm.sh: $root is not a Debian: tools/arm.sh makes it" >&2; exit 1; }
chroot "$root" apt-get install -y -q --no-install-recommends libgtest-dev >/dev/null
export QEMU_LD_PREFIX=$root # what the build runs finds the libraries of ROOT
cmake -S . -B build-arm64-tests --preset release --toolchain "$PWD/cmake/Arm64.cmake" -DSPARSELENS_SYSROOT="$root" --log-level=WARNING \
    -DSPARSELENS_{BENCHMARKS,PYTHON,LAB,GPU,BUNDLE}=OFF -DSPARSELENS_TESTS=ON
cmake --build build-arm64-tests -j "$(nproc)" --target sparselens-tests
inside() { # COMMAND...: in ROOT, whose links lead to its own libraries
    unshare --mount bash -c 'mkdir -p "$0$1" && mount --bind "$1" "$0$1" && mount -t proc proc "$0/proc" &&
        exec chroot "$0" env -C "$1/build-arm64-tests/tests" LC_ALL=C.UTF-8 "${@:2}"' "$root" "$PWD" "$@"
}
shards=$(nproc) failed=0
for ((i = 0; i < shards; ++i)); do
    inside env GTEST_TOTAL_SHARDS=$shards GTEST_SHARD_INDEX=$i ../bin/sparselens-tests --gtest_brief --gtest_filter="$filter" \
        >"build-arm64-tests/tests.$i.log" 2>&1 &
done
wait
for ((i = 0; i < shards; ++i)); do
    grep -E '^\[( +PASSED +| +FAILED +)\]' "build-arm64-tests/tests.$i.log" || failed=1
    ! grep -q '^\[  FAILED' "build-arm64-tests/tests.$i.log" || failed=1
done
exit $failed
