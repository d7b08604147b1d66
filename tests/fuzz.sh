#!/bin/bash
# Long fuzzing with libFuzzer, under AddressSanitizer and UndefinedBehaviorSanitizer.
#
#   tests/fuzz.sh [SECONDS [TARGET...]]     600 seconds for each target with a folder in tests/fuzz/corpus
#
# Begins with the kept corpus, tests/fuzz/corpus; new inputs go to build-fuzz/corpus, failures to build-fuzz/found.
# Needs clang-14; exits with 77 without it.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
exec </dev/null
command -v clang++-14 >/dev/null || { echo "skipped: clang++-14 is not installed"; exit 77; }
seconds=${1:-600}
shift || true
targets=("$@")
[ $# -gt 0 ] || targets=(tests/fuzz/corpus/*)
targets=("${targets[@]##*/}")

cmake --preset fuzz --log-level=WARNING
cmake --build build-fuzz -j "$(nproc)" --target "${targets[@]/#/fuzz-}"
mkdir -p build-fuzz/found
code=0
for target in "${targets[@]}"; do
    mkdir -p build-fuzz/corpus/"$target"
    echo "== $target"
    build-fuzz/fuzz/fuzz-"$target" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=1024 -max_len=65536 \
        -close_fd_mask=3 -print_final_stats=1 -artifact_prefix=build-fuzz/found/"$target"- \
        build-fuzz/corpus/"$target" tests/fuzz/corpus/"$target" 2>&1 | tail -n 12 || code=1
done
exit $code
