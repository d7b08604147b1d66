#!/bin/bash
# Depths as other programs write them: negative, and from 0 to 1 between two planes.
. "$(dirname "$0")/check.sh"
lens=(--focal-length 50 --sensor-width 36 --lens-radius 0.4 --focus-distance 2)
gather=$bin/dof-gather
dark=(R=0.9 G=0.2 B=0.1) # farther, at 6
checker() { picture make "$1" 24x16 R=0.1 G=0.5 B=0.2 A=1 Z="$2" fill=8x8+8+0 "${dark[@]}" Z="$3" fill=8x8+0+8 "${dark[@]}" Z="$3" fill=8x8+16+8 "${dark[@]}" Z="$3"; }
checker plain.exr 2 6
checker negative.exr -2 -6
checker normalized.exr 0.125 0.625 # 0 at 1, 1 at 9
same_depth() { picture same expected.exr "$1" 1e-5 >found || fail "$2 ($(cat found))"; }
exits 0 "$gather" plain.exr -o x.exr --lens-radius 0 --depth-out expected.exr
picture edit normalized.exr header.exr set=near:1 set=far:9
exits 0 "$gather" header.exr -o x.exr --lens-radius 0 --depth-out header.z.exr --depth normalized
same_depth header.z.exr "near and far of the header"

checker hyperbolic.exr 0.5625 0.9375 # 0 at 1, 1 at 9, linear in 1 / z
fails_saying 2 '--depth hyperbolic: .* is unknown: give --near and --far' "$gather" hyperbolic.exr -o x.exr "${lens[@]}" --depth hyperbolic

# Every tool that reads depth has the near plane.
differ() { if cmp -s "$1" "$2"; then fail "$3 changes nothing"; fi; }
for near in 1 3; do
    far=(--depth normalized --far 9)
    exits 0 "$bin/ldi-plan" normalized.exr "${lens[@]}" "${far[@]}" --noise 0 -o near.$near.json --near $near
    exits 0 "$bin/ldi-warp" normalized.exr "${lens[@]}" "${far[@]}" -o warped.$near.exr --near $near
    exits 0 "$bin/ldi-cluster" normalized.exr "${lens[@]}" "${far[@]}" -o clustered.$near.exr --near $near
    exits 0 "$bin/dof-compare" plain.exr negative.exr --json --regions normalized.exr "${lens[@]}" "${far[@]}" --near $near
    mv stdout compared.$near.json
done
differ near.1.json near.3.json "ldi-plan --near"
differ warped.1.exr warped.3.exr "ldi-warp --near"
differ clustered.1.exr clustered.3.exr "ldi-cluster --near"
differ compared.1.json compared.3.json "dof-compare --near"

# Missing or ignored options are wrong usage; depths that need an option give an error that names it.
fails_saying 2 '--depth normalized: .* 0 and which is 1 is unknown: give --near and --far' "$gather" normalized.exr -o x.exr "${lens[@]}" --depth normalized
fails_saying 2 '--depth normalized: .* is unknown: give --far' "$gather" normalized.exr -o x.exr "${lens[@]}" --depth normalized --near 1
fails_saying 2 '--near works with --depth normalized and --depth hyperbolic only' "$gather" plain.exr -o x.exr "${lens[@]}" --near 1
fails_saying 1 'negative.exr: depth -2 in pixel 0,0 .*--depth says what the channel holds \(negative' "$gather" negative.exr -o x.exr "${lens[@]}"
checker clipped.exr 0.38333334 1
exits 0 "$gather" clipped.exr -o x.exr "${lens[@]}"
grep -q 'warning: clipped.exr: its depths end at exactly 1, .*--depth normalized with --near and --far, or --depth hyperbolic' stderr || fail "no warning: $(cat stderr)"
