#!/bin/bash
# Invalid values in pictures, through the tools: counted, reported in one line, and never spread over a bokeh disc.
. "$(dirname "$0")/check.sh"
lens=(--focal-length 36 --sensor-width 36 --focus-distance 5)
radius=(--lens-radius 1)

# says_only PATTERN: the last command printed one line on stderr, a warning that matches the pattern.
says_only() {
    [ "$(wc -l <stderr)" -eq 1 ] && grep -Eq -e "warning: $1" stderr || fail "not the warning '$1': $(cat stderr)"
}

# A grey plane at depth 10 (64 px wide: CoC 6.4 px) with one other pixel in the middle.
one_pixel() { picture edit plane.exr bad.exr fill=1x1+32+32 "$@"; } # CHANNEL=VALUE...
picture make plane.exr 64x64 R=0.5 G=0.5 B=0.5 A=1 Z=10
exits 0 "$bin/dof-gather" plane.exr -o good.exr -d float "${lens[@]}" "${radius[@]}"
[ ! -s stderr ] || fail "a good picture is complained of: $(cat stderr)"

for bad in nan inf -inf; do
    one_pixel R=$bad G=$bad B=$bad
    exits 0 "$bin/dof-gather" bad.exr -o out.exr -d float "${lens[@]}" "${radius[@]}"
    says_only 'bad.exr: 3 colours that are not finite'
    picture same out.exr good.exr 1e-6 || fail "a pixel of $bad shows in the picture"
    exits 0 "$bin/ldi-cluster" bad.exr -o ldi.exr "${lens[@]}" "${radius[@]}"
    says_only 'bad.exr: 3 colours that are not finite'
    exits 0 "$bin/ldi-warp" bad.exr --view 1,0 plane.exr -o ldi.exr "${lens[@]}" "${radius[@]}"
    says_only 'bad.exr: 3 colours that are not finite'
done
for bad in nan -3 -inf; do
    one_pixel Z=$bad
    exits 0 "$bin/dof-gather" bad.exr -o out.exr -d float "${lens[@]}" "${radius[@]}"
    says_only 'bad.exr: 1 depth that is not above 0'
    picture same out.exr good.exr 1e-6 || fail "a depth of $bad shows in the picture"
done
one_pixel A=1.5
exits 0 "$bin/dof-gather" bad.exr -o out.exr -d float "${lens[@]}" "${radius[@]}"
says_only 'bad.exr: 1 alpha outside 0..1'
picture same out.exr good.exr 1e-6 || fail "an A of 1.5 shows in the picture"
