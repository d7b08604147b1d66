#!/bin/bash
# dof-match from the shell: the hidden lens of ray-traced plates, the keys that dof-gather reads, the effect of each
# option, and plates that cannot be matched.
#   bash dof-match.sh BIN_DIR [--all]     without --all (tools.dof-match-all), one plate, no flat pictures, rack or shape
. "$(dirname "$0")/check.sh"
match=$bin/dof-match
answers_help dof-match ldi.exr plate.exr

exits 0 "$bin/dof-trace" fence --size 96x54 --spp 16 --lens-radius 0.27 -o fence
exits 0 "$bin/ldi-warp" fence/center.exr fence/view_{0..3}.exr -o ldi.exr
plate() { # plate NAME FOCUS RADIUS
    exits 0 "$bin/dof-trace" fence --size 96x54 --views 0 --spp 1 --reference 96 --focus-distance "$2" \
        --lens-radius "$3" -o traced
    # Another exposure, a tone curve, JPEG: nothing but blur is compared.
    oiiotool traced/reference.exr --ch R,G,B --mulc 0.6,0.7,0.65 --powc 0.45 --clamp:max=1 -d uint8 \
        --compression jpeg:85 -o graded.jpg
    oiiotool graded.jpg -d half -o "$1"
}
# holds NAME LEAST MOST: a value that --json printed lies between the two.
value() { grep -A1 "\"$1\": {" stdout | grep -o '"value": [0-9.]*' | cut -d' ' -f2; }
holds() { awk "BEGIN { exit !($(value "$1") >= $2 && $(value "$1") <= $3) }" || fail "$1 is $(value "$1"), not $2 to $3"; }

# R F is 25.9 pixels: at 3 units, the disparity is 8.5, and half a pixel of CoC is 0.3 units. 0.15 stops are 5 %.
plate plate.exr 3 0.24
exits 0 "$match" ldi.exr plate.exr --json -o keys.json --show fit.png --stats stats.json
holds focus_distance 2.8 3.25
holds lens_radius 0.228 0.252
grep -q '"tool":"dof-match"' stats.json || fail "--stats: $(cat stats.json)"
oiiotool --info fit.png | grep -q ' 192 x *54,' || fail "--show: $(oiiotool --info fit.png)"
radius=$(value lens_radius)

# One value may be known: the f-stop, here in a region; 0.073 is a radius of 0.247.
by_region=("$match" ldi.exr plate.exr --json --fit focus --fstop 0.073 --region 3,6,92,50)
exits 0 "${by_region[@]}" -o region.json
holds focus_distance 2.8 3.25
holds fstop 0.073 0.073
exits 0 "${by_region[@]}" -o region.json --progress plain
grep -qx 'dof-match: 100%' stderr || fail "dof-match --progress: $(cat stderr)"

# Plates come in formats of the screen, too: they are decoded by the file rules, and have the lens of the EXR.
formats=(jpg)
[ "${2:-}" != --all ] || formats+=(png dpx tif)
for format in "${formats[@]}"; do
    oiiotool plate.exr --colorconvert linear sRGB -o "encoded.$format"
    exits 0 "$match" ldi.exr "encoded.$format" --json --fit focus --fstop 0.073 --region 3,6,92,50 -v
    holds focus_distance 2.8 3.25
    grep -q "encoded.$format: colour space sRGB" stderr || fail "$format is not decoded: $(cat stderr)"
done
head -c 700 encoded.jpg >broken.png
fails_saying 1 'broken.png: cannot read' "$match" ldi.exr broken.png

if [ "${2:-}" = --all ]; then
    # ... or the focus, here of another camera: with four times the focal length in pixels, a quarter of the lens blurs as
    # much.
    exits 0 "$match" ldi.exr plate.exr --json --fit fstop --focus-distance 3 --focal-length 72 --sensor-width 18 \
        --scene-unit 0.1 --lens-radius 0.0675
    holds focus_distance 3 3
    holds lens_radius 0.0569 0.0631
    holds fstop 5.7 6.3

    # From a flat picture with depth, of proxy geometry say, whose depth may be of any kind.
    exits 0 "$match" fence/center.exr plate.exr --json
    holds focus_distance 2.8 3.25
    holds lens_radius 0.216 0.252 # one view does not know what is hidden
    by_depth() { # by_depth FLAT OPTIONS...: the focus is that of planar depth. The lens radius is known.
        exits 0 "$match" "$1" plate.exr --json --fit focus --lens-radius 0.24 "${@:2}"
        holds focus_distance "$least" "$most"
        holds lens_radius 0.24 0.24
    }
    least=2.8 most=3.25 by_depth fence/center.exr
    least=$(awk "BEGIN { print $(value focus_distance) - 0.01 }") most=$(awk "BEGIN { print $(value focus_distance) + 0.01 }")
    with_depth() { # with_depth OUT WORDS...: oiiotool changes the depth by these words.
        oiiotool fence/center.exr --ch R,G,B,A fence/center.exr --ch Z "${@:2}" --chappend -o "$1"
    }
    with_depth inverse.exr --powc -1 --chnames away
    by_depth inverse.exr --depth inverse --depth-channel away
    with_depth normalized.exr --subc 1 --mulc 0.05 # 0 at 1, 1 at 21
    by_depth normalized.exr --depth normalized --near 1 --far 21
fi

# Options that all tools share.
exits 0 "${by_region[@]}" --threads 1 -o again.json -v
cmp -s region.json again.json || fail "--threads changes the keys"
grep -q 'threads: 1' stderr || fail "-v: $(cat stderr)"
exits 1 "$match" ldi.exr plate.exr --max-memory 1KB
grep -q 'more than --max-memory allows' stderr || fail "--max-memory: $(cat stderr)"

# dof-gather reads the keys.
exits 0 "$bin/dof-gather" ldi.exr --frames 1 --focus-distance @keys.json --lens-radius @keys.json -o by-keys.####.exr
exits 0 "$bin/dof-gather" ldi.exr --focus-distance "$(grep -A1 '"focus_distance": {' keys.json | grep -o '[0-9.]*$')" \
    --lens-radius "$radius" -o by-hand.exr
picture same by-keys.0001.exr by-hand.exr 0.001 || fail "@keys.json"
fails_saying 2 'keys.json: has no "blades"' "$bin/dof-gather" ldi.exr --frames 1 --blades @keys.json -o x.####.exr

if [ "${2:-}" = --all ]; then
    # A rack of focus; a frame without a plate to match gets its neighbours' values.
    focus_of() { awk "BEGIN { print 2 + 0.4 * $1 }"; }
    for frame in 2 3 4; do plate "rack.000$frame.exr" "$(focus_of $frame)" 0.18; done
    picture edit rack.0002.exr rack.0001.exr R=0 G=0 B=0
    cp rack.0001.exr rack.0005.exr
    exits 0 "$match" ldi.exr "rack.####.exr" --frames 1-4 -o rack.json
    grep -q '^ *frame  focus distance' stdout || fail "the table: $(cat stdout)"
    [ "$(wc -l <stdout)" -eq 5 ] || fail "a line for each frame of --frames: $(cat stdout)"
    for frame in 2 3 4; do
        awk -v at="$(sed -n "$((frame + 1))p" stdout | awk '{ print $2 }')" -v true="$(focus_of $frame)" \
            'BEGIN { d = 17.28 * (1 / at - 1 / true); exit !(d > -0.5 && d < 0.5) }' || fail "frame $frame: $(cat stdout)"
    done
    grep -q 'warning: rack.0001.exr: .*its values are those of its neighbours' stderr || fail "a black frame: $(cat stderr)"

    # Near focus, a wider lens blurs like a softer plate: the f-stop cannot be told there, but the focus can.
    exits 0 "$bin/dof-trace" slant --size 160x90 --spp 16 -o slant
    exits 0 "$bin/ldi-warp" slant/center.exr slant/view_{0..3}.exr -o slant.ldi.exr
    exits 0 "$bin/dof-trace" slant --size 160x90 --views 0 --spp 1 --reference 200 --focus-distance 3.26 \
        --lens-radius 0.04 -o traced
    fails_saying 1 'the f-stop cannot be told' "$match" slant.ldi.exr traced/reference.exr --region 40,40,139,79
    exits 0 "$match" slant.ldi.exr traced/reference.exr --region 40,40,139,79 --fit focus --lens-radius 0.04 --json
    holds focus_distance 3.1 3.42

    # The discs of lamps show the blades.
    exits 0 "$bin/dof-trace" lamps --size 160x90 --spp 8 --lens-radius 0.32 -o lamps
    exits 0 "$bin/ldi-warp" lamps/center.exr lamps/view_{0..3}.exr -o lamps.ldi.exr
    exits 0 "$bin/dof-gather" lamps.ldi.exr --focus-distance 2.5 --blades 6 --blade-rotation 17 -o blades.exr
    exits 0 "$match" lamps.ldi.exr blades.exr --shape --fit fstop --focus-distance 2.5 -o blades.json
    grep -qE '^--blades 6 --blade-rotation 1[678] --squeeze 1.00$' stdout || fail "--shape: $(cat stdout)"
    exits 0 "$bin/dof-gather" lamps.ldi.exr --frames 1 --blades @blades.json --blade-rotation @blades.json -o again.####.exr
fi

# Plates that cannot be matched say why.
picture edit plate.exr black.exr R=0 G=0 B=0
fails_saying 1 'black.exr: .*shows nothing to compare' "$match" ldi.exr black.exr
if [ "${2:-}" = --all ]; then
    exits 0 "$bin/dof-trace" planes --size 96x54 --views 0 --spp 1 --reference 64 -o other
    fails_saying 1 'something else than the LDI' "$match" ldi.exr other/reference.exr --fit fstop --focus-distance 3
    oiiotool plate.exr --kernel box 11x1 --convolve -o moved.exr
    fails_saying 1 'blurred by motion' "$match" ldi.exr moved.exr --fit focus --lens-radius 0.24
    plate sharp.exr 4 0.003
    fails_saying 1 'out of focus' "$match" ldi.exr sharp.exr --fit fstop --focus-distance 4
fi
oiiotool plate.exr --resize 48x27 -o small.exr
fails_saying 1 'small.exr: its display window is 48x27' "$match" ldi.exr small.exr
[ ! -e x.json ] || fail "keys of a plate that cannot be matched"

# Mistakes.
for region in 1,2,3 5,0,4,5 a,b,c,d 0,0,5,-1; do
    fails_saying 2 '--region' "$match" ldi.exr plate.exr --region "$region"
done
fails_saying 2 'contains no pixel' "$match" ldi.exr plate.exr --region 500,500,509,509
fails_saying 2 '--fit' "$match" ldi.exr plate.exr --fit lens
fails_saying 2 '--fstop' "$match" ldi.exr plate.exr --lens-radius 0
