#!/bin/bash
# The memory of dof-gather for deep files of many samples, measured by the growth between two sizes, so that fixed costs
# of a process do not count: at most 24 bytes per sample and 100 bytes per pixel, and without a lens half as much per
# sample, because samples are flattened as they are read. A picture no higher than its bands need is gathered at once:
# from 20 bytes per sample and 48 made from each, in vectors that double as they grow. On one thread, because with
# several the pieces in memory depend on timing. bash memory.sh BIN_DIR
. "$(dirname "$0")/check.sh"
command -v python3 >/dev/null || skip "needs python3"
[ -x "$bin/sparselens-deep-scene" ] || skip "needs the benchmarks (SPARSELENS_BENCHMARKS)"

cat >peak.py <<'END'
# peak.py COMMAND...: runs it and prints the most memory that it held, bytes.
import resource, subprocess, sys
subprocess.run(sys.argv[1:], check=True)
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss * 1024)
END

quality=draft
# measure SCENE WIDTH HEIGHT CoC: sets `peak`, of dof-gather at that quality, and `samples`. The CoCs are CoC times
# those of the scene at all sizes.
measure() {
    exits 0 "$bin/sparselens-deep-scene" "$1" "$2" "$3" in.exr
    rm -f stats.json
    peak=$(python3 peak.py "$bin/dof-gather" in.exr -o out.exr --lens-radius "$(awk "BEGIN { print 144 / $2 * $4 }")" \
        --quality $quality --threads 1 --stats stats.json)
    samples=$(sed -E 's/.*"samples":([0-9]+).*/\1/' stats.json)
}

# check SCENE WIDTH HEIGHT CoC BYTES [BEYOND]: twice the width and height takes at most this many bytes more per sample.
# BEYOND pixels of a row continue beyond the frame, at either size, and count like the others.
check() {
    measure $1 $2 $3 $4
    local small=$peak fewer=$samples
    measure $1 $((2 * $2)) $((2 * $3)) $4
    local grown=$((peak - small)) allowed=$(($5 * (samples - fewer) + 100 * (3 * $2 + ${6-0}) * $3))
    printf '%-8s CoC %s %10d bytes more (at most %d)\n' $1 $4 $grown $allowed
    [ $grown -le $allowed ] || fail "$1: $small bytes at $2x$3, $peak at $((2 * $2))x$((2 * $3))"
}

check dense 192 108 1 24
check hair 384 216 1 24
# These are gathered in bands, whose least height does not grow with the picture: with tall pictures, small ones show
# the growth.
check apart 32 1600 1 24
check tinted 16 1600 1 24 64 # a cell of 32 on each side, much for so narrow a picture
check volume 24 800 1 24
check dense 192 108 0 12
check volume 96 54 0 12
# Pictures of usual shape, gathered at once.
check apart 96 54 1 136
check tinted 96 54 1 136
check volume 96 54 1 136
quality=normal
check dense 192 108 1 24

# warped WIDTH HEIGHT: sets `peak`, of ldi-warp with five views of that size, a board before a wall; colours are halves.
warped() {
    picture make view.exr $1x$2 R=0..1 G=0.5 B=0.25 A=1 Z=8 fill=$(($1 / 2))x$(($2 / 2)) G=1 Z=2 half=R,G,B,A
    peak=$(python3 peak.py "$bin/ldi-warp" view.exr --view 0.01,0 view.exr --view -0.01,0 view.exr --view 0,0.01 view.exr \
        --view 0,-0.01 view.exr -o out.exr --lens-radius 0.01 --focal-length 50 --sensor-width 36 --threads 1 2>/dev/null)
}

# While they are read, five views take 24 bytes per pixel each; while they are warped, 11, and the LDI takes 50.
warped 640 360
small=$peak
warped 1280 720
grown=$((peak - small)) allowed=$((170 * 3 * 640 * 360))
printf 'five views %15d bytes more (at most %d)\n' $grown $allowed
[ $grown -le $allowed ] || fail "ldi-warp: $small bytes at 640x360, $peak at 1280x720"

# In cells, in bands of rows: the same as at once, even if the depth of everything is requested. All CoCs are larger
# than 64 pixels. Bands take three fifths of the memory.
exits 0 "$bin/sparselens-deep-scene" apart 48 2600 in.exr
by=(-d float --lens-radius 1.5 --focus-distance 1.3 --threads 1)
banded=$(python3 peak.py "$bin/dof-gather" in.exr -o banded.exr "${by[@]}")
at_once=$(python3 peak.py "$bin/dof-gather" in.exr -o at-once.exr "${by[@]}" --depth-out depth.exr)
[ $((4 * banded)) -lt $((3 * at_once)) ] || fail "no bands: $banded bytes, $at_once at once"
picture same banded.exr at-once.exr >found || fail "bands: $(cat found)"
