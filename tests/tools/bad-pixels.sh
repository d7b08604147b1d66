#!/bin/bash
# Values that no picture can mean, through the tools: counted, said in one line, and never spread over a bokeh disc.
. "$(dirname "$0")/check.sh"
for tool in oiiotool idiff; do command -v $tool >/dev/null || skip "needs $tool (openimageio-tools)"; done
lens=(--focal-length 36 --sensor-width 36 --focus-distance 5)
radius=(--lens-radius 1)

# says_only PATTERN: the last command said one line on stderr, a warning with the pattern in it.
says_only() {
    [ "$(wc -l <stderr)" -eq 1 ] && grep -Eq -e "warning: $1" stderr || fail "not the warning '$1': $(cat stderr)"
}

# A grey plane at depth 10 (64 px wide: CoC 6.4 px) with one other pixel in the middle.
plane() { oiiotool --pattern constant:color=0.5,0.5,0.5,1,10 64x64 5 --chnames R,G,B,A,Z -d float -o "$1"; }
one_pixel() { # COLOUR OUT
    oiiotool --pattern constant:color="$1" 1x1 5 --chnames R,G,B,A,Z -d float -o pixel.exr
    oiiotool pixel.exr plane.exr --paste +32+32 -d float -o "$2"
}
plane plane.exr
exits 0 "$bin/dof-gather" plane.exr -o good.exr -d float "${lens[@]}" "${radius[@]}"
[ ! -s stderr ] || fail "a good picture is complained of: $(cat stderr)"

for bad in nan inf -inf; do
    one_pixel "$bad,$bad,$bad,1,10" bad.exr
    exits 0 "$bin/dof-gather" bad.exr -o out.exr -d float "${lens[@]}" "${radius[@]}"
    says_only 'bad.exr: 3 colours that are not finite'
    idiff -q -fail 1e-6 -warn 1e-6 out.exr good.exr || fail "a pixel of $bad shows in the picture"
    exits 0 "$bin/ldi-cluster" bad.exr -o ldi.exr "${lens[@]}" "${radius[@]}"
    says_only 'bad.exr: 3 colours that are not finite'
    exits 0 "$bin/ldi-warp" bad.exr --view 1,0 plane.exr -o ldi.exr "${lens[@]}" "${radius[@]}"
    says_only 'bad.exr: 3 colours that are not finite'
done
for bad in nan -3 -inf; do
    one_pixel "0.5,0.5,0.5,1,$bad" bad.exr
    exits 0 "$bin/dof-gather" bad.exr -o out.exr -d float "${lens[@]}" "${radius[@]}"
    says_only 'bad.exr: 1 depth that is not above 0'
    idiff -q -fail 1e-6 -warn 1e-6 out.exr good.exr || fail "a depth of $bad shows in the picture"
done
one_pixel 0.5,0.5,0.5,1.5,10 bad.exr
exits 0 "$bin/dof-gather" bad.exr -o out.exr -d float "${lens[@]}" "${radius[@]}"
says_only 'bad.exr: 1 alpha outside 0..1'
idiff -q -fail 1e-6 -warn 1e-6 out.exr good.exr || fail "an A of 1.5 shows in the picture"
