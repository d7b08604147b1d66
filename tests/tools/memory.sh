#!/bin/bash
# How much memory dof-gather takes of deep files of many samples: at most 24 bytes a sample and 100 bytes a pixel, by the
# growth between two sizes, so that what a process takes anyway does not count. bash memory.sh BIN_DIR
. "$(dirname "$0")/check.sh"
command -v python3 >/dev/null || skip "needs python3"
[ -x "$bin/sparselens-deep-scene" ] || skip "needs the benchmarks (SPARSELENS_BENCHMARKS)"

cat >peak.py <<'END'
# peak.py COMMAND...: runs it and prints the most memory that it held, bytes.
import resource, subprocess, sys
subprocess.run(sys.argv[1:], check=True)
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss * 1024)
END

# measure SCENE WIDTH HEIGHT: sets `peak`, of dof-gather at draft quality, and `samples`. The CoCs are the same at all sizes.
measure() {
    exits 0 "$bin/sparselens-deep-scene" "$1" "$2" "$3" in.exr
    rm -f stats.json
    peak=$(python3 peak.py "$bin/dof-gather" in.exr -o out.exr --lens-radius "$(awk "BEGIN { print 144 / $2 }")" \
        --quality draft --threads 2 --stats stats.json)
    samples=$(sed -E 's/.*"samples":([0-9]+).*/\1/' stats.json)
}

for scene in dense hair; do
    measure $scene 384 216
    small=$peak fewer=$samples
    measure $scene 768 432
    grown=$((peak - small)) allowed=$((24 * (samples - fewer) + 100 * (768 * 432 - 384 * 216)))
    printf '%-8s %9d bytes more (at most %d)\n' $scene $grown $allowed
    [ $grown -le $allowed ] || fail "$scene: $small bytes at 384x216, $peak at 768x432"
done
