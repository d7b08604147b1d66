#!/bin/bash
# Views, LDIs and pictures of sub-pixels: which file or option gives their number, and its effect.
#   bash supersample.sh BIN_DIR
. "$(dirname "$0")/check.sh"
command -v oiiotool >/dev/null || skip "needs oiiotool (openimageio-tools)"
window() { exrheader "$1" | sed -nE "s/^$2 \(type box2i\): //p"; } # FILE dataWindow|displayWindow
expect_window() { [ "$(window "$1" "$2")" = "$3" ] || fail "$1: $2 $(window "$1" "$2"), not $3"; }
same() { picture same "$1" "$2" "${4:-0}" >found || fail "$3 ($(cat found))"; }
says_two() { grep -q '^ldi.supersample (type int): 2$' <<<"$(exrheader "$1")" || fail "$1 does not say ldi.supersample"; }
says_none() { ! grep -q 'ldi\.supersample\|ldi\.pixelFilter' <<<"$(exrheader "$1")" || fail "$1 speaks of sub-pixels"; }
# halved FINE OUT WxH: the mean of each 2 x 2 pixels.
halved() { oiiotool "$1" --resize:filter=box "$3" -d float -o "$2"; }

# dof-trace: the same number of rays in smaller pixels; the reference has the picture's size.
exits 0 "$bin/dof-trace" fence --size 80x48 --spp 8 --views 2 --supersample 2 --overscan 2 --reference 1 --deep visible -o views
exits 0 "$bin/dof-trace" fence --size 160x96 --spp 2 --views 2 --overscan 4 -o plain
for file in center view_0 view_1; do
    picture same views/$file.exr plain/$file.exr >found || fail "$file is not that of twice the size ($(cat found))"
    says_two views/$file.exr
    says_none plain/$file.exr
done
says_two views/deep_visible.exr
says_none views/reference.exr
expect_window views/reference.exr displayWindow '(0 0) - (79 47)'
expect_window views/center.exr dataWindow '(-4 -4) - (163 99)'
fails_saying 2 '--spp must be a multiple of 4' "$bin/dof-trace" fence --spp 6 --supersample 2 -o x

# Every tool that writes views, plans or LDIs repeats the number; a plan is rendered in the same pixels.
exits 0 "$bin/ldi-plan" views/center.exr -o plan.json
exits 0 "$bin/dof-trace" fence --size 80x48 --spp 8 --supersample 2 --overscan 2 --plan plan.json -o planned
says_two planned/view_0.exr
fails_saying 1 'same --size and --supersample' "$bin/dof-trace" fence --size 80x48 --plan plan.json -o x
exits 0 "$bin/ldi-warp" views/center.exr views/view_?.exr -o warped.exr
says_two warped.exr
exits 0 "$bin/ldi-cluster" warped.exr -o ldi.exr
says_two ldi.exr
exits 0 "$bin/ldi-cluster" warped.exr views/deep_visible.exr -o merged.exr
says_two merged.exr

# dof-gather: the picture has the intended size, and each of its pixels is the mean of four; --supersample 1 shows
# these, and files without the attribute need the option.
exits 0 "$bin/dof-gather" ldi.exr -d float -o out.exr --depth-out depth.exr
expect_window out.exr displayWindow '(0 0) - (79 47)'
expect_window out.exr dataWindow '(-2 -2) - (81 49)'
expect_window out.exr sparselens:dataWindow '' # the LDI's, in sub-pixels
says_none out.exr
exits 0 "$bin/dof-gather" ldi.exr -d float -o full.exr --supersample 1 --depth-out full-depth.exr
expect_window full.exr displayWindow '(0 0) - (159 95)'
expect_window full.exr dataWindow '(-4 -4) - (163 99)'
says_none full.exr
oiiotool ldi.exr --eraseattrib ldi.supersample -o unsaid.exr
exits 0 "$bin/dof-gather" unsaid.exr -d float -o told.exr --supersample 2
same told.exr out.exr "--supersample 2 of a file that says nothing"
fails_saying 2 'ldi.exr: its display window cannot be divided .* --supersample' "$bin/dof-gather" ldi.exr -o x.exr --supersample 7
fails_saying 2 '--supersample' "$bin/dof-gather" ldi.exr -o x.exr --supersample 0
oiiotool ldi.exr --attrib:type=int ldi.supersample 99 -o wrong.exr
exits 0 "$bin/dof-gather" wrong.exr -d float -o x.exr -v
grep -q 'ldi.supersample is 99, not from 1 to 16; --supersample settles it' stderr || fail "99 sub-pixels: $(cat stderr)"
same x.exr full.exr "99 sub-pixels"

# Depth is that of one sub-pixel, the middle one, and never a mean. The same holds for the focus pixel.
at() { picture pixel "$1" "$2" Z; }
for pixel in 3,5 40,24 70,13; do
    [ "$(at depth.exr $pixel)" = "$(at full-depth.exr $((2 * ${pixel%,*} + 1)),$((2 * ${pixel#*,} + 1)))" ] || fail "the depth of pixel $pixel"
    exits 0 "$bin/dof-gather" ldi.exr -o x.exr --focus-pixel $pixel -v
    grep -q "the focus distance is .*, the depth of pixel $pixel" stderr || fail "--focus-pixel: $(cat stderr)"
    exits 0 "$bin/dof-gather" ldi.exr -d float -o focused.exr --focus-pixel $pixel
    exits 0 "$bin/dof-gather" ldi.exr -d float -o expected.exr --focus-distance "$(at depth.exr $pixel)"
    same focused.exr expected.exr "--focus-pixel $pixel" 1e-3 # the depth is printed with six digits
done

# --region and --overscan count pixels of the picture, also under a wide filter; --proxy shrinks the picture further.
filter=(--pixel-filter blackman-harris)
exits 0 "$bin/dof-gather" ldi.exr -d float -o filtered.exr "${filter[@]}"
picture differ filtered.exr out.exr || fail "--pixel-filter has no effect"
exits 0 "$bin/dof-gather" ldi.exr -d float -o named.exr --pixel-filter blackman-harris:1.5
same named.exr filtered.exr "the default width"
exits 0 "$bin/dof-gather" ldi.exr -d float -o named.exr --pixel-filter box
same named.exr out.exr "--pixel-filter box"
oiiotool ldi.exr --attrib ldi.pixelFilter blackman-harris:1.5 -o says.exr
exits 0 "$bin/dof-gather" says.exr -d float -o named.exr
same named.exr filtered.exr "ldi.pixelFilter"
for wrong in mitchell gaussian:0 box:2; do fails_saying 2 '--pixel-filter' "$bin/dof-gather" ldi.exr -o x.exr --pixel-filter $wrong; done
exits 0 "$bin/dof-gather" ldi.exr -d float -o region.exr "${filter[@]}" --region 30,10,49,29
expect_window region.exr dataWindow '(30 10) - (49 29)'
picture edit filtered.exr expected.exr crop=20x20+30+10
same region.exr expected.exr "--region"
exits 0 "$bin/dof-gather" ldi.exr -d float -o crop.exr "${filter[@]}" --overscan crop
picture edit filtered.exr expected.exr crop=80x48
same crop.exr expected.exr "--overscan crop"
exits 0 "$bin/dof-gather" ldi.exr -o proxy.exr --proxy 2
expect_window proxy.exr displayWindow '(0 0) - (39 23)'
exits 0 "$bin/dof-gather" ldi.exr -o shown.exr --show tiles
expect_window shown.exr displayWindow '(0 0) - (79 47)'

# The picture equals the mean of the large picture's sub-pixels: with each method, with looks, in frames, on a device.
as_large() { # OPTIONS...: small.exr and expected.exr of the display window
    exits 0 "$bin/dof-gather" ldi.exr -d float -o large.exr --supersample 1 "$@"
    picture edit large.exr cut.exr crop=160x96
    halved cut.exr expected.exr 80x48
    exits 0 "$bin/dof-gather" ldi.exr -d float -o out-small.exr "$@"
    picture edit out-small.exr small.exr crop=80x48
}
as_large --method selective
same small.exr expected.exr "--method selective" 1e-5
as_large --lens-radius 0
same small.exr expected.exr "--lens-radius 0" 1e-5
# With lens points of its own choice, and in cells where everything is far out of focus: at most 0.3 dB below the
# measured distance from 1024 lens points at each sub-pixel (docs/tolerances.md, section 5).
far='--focus-distance 0.5 --lens-radius 0.2'
while read -r measured look; do
    exits 0 "$bin/dof-gather" ldi.exr -d float -o large.exr --supersample 1 --lens-samples 1024 $look
    picture edit large.exr cut.exr crop=160x96
    halved cut.exr expected.exr 80x48
    exits 0 "$bin/dof-gather" ldi.exr -d float -o all.exr $look
    picture edit all.exr small.exr crop=80x48
    exits 0 "$bin/dof-compare" small.exr expected.exr --json
    psnr=$(sed -nE 's/.*"psnr_tonemapped": *([0-9.]+).*/\1/p' stdout | head -1)
    echo "mean of sub-pixels: $psnr dB, $look"
    awk -v a="$psnr" -v b="$measured" 'BEGIN { exit !(a >= b - 0.3) }' || fail "$look: $psnr dB from the mean of the sub-pixels, not $measured"
done <<END
47.63
43.66 --blades 5 --cat-eye 0.5 --tilt 5,0 --axial-chromatic 0.05 --breathing 1
46.42 --highlight-gain 4 --highlight-threshold 0.5
51.61 $far
49.75 $far --blades 5 --cat-eye 1 --axial-chromatic 0.05
END
exits 0 "$bin/dof-gather" ldi.exr -d float -o pull.#.exr --frames 1-2 --focus-distance 1:2.5,2:6
exits 0 "$bin/dof-gather" ldi.exr -d float -o alone.exr --focus-distance 6
same pull.0002.exr alone.exr "the second frame"
exits 0 "$bin/dof-gather" --device list
name=$(head -n 1 stdout)
if [ "$name" != "Vulkan gives access to no device here" ]; then
    exits 0 "$bin/dof-gather" ldi.exr -d float -o device.exr --device "${name%% (*}" -v
    grep -q 'tiles gathered by the device: [1-9]' stderr || fail "--device: $(cat stderr)"
    same device.exr out.exr "--device" 1e-4
fi

# A holdout has the LDI's size, or the picture's; both hide the same.
card() { oiiotool --pattern constant:color=1,0,0,1,3 "$1" 5 --chnames R,G,B,A,Z --fullsize "$2" -d float --deepen -o "$3"; }
card 80x96 160x96 fine.exr
card 40x48 80x48 coarse.exr
for how in "" --holdout-defocused; do
    exits 0 "$bin/dof-gather" ldi.exr -d float -o fine-out.exr --holdout fine.exr $how
    exits 0 "$bin/dof-gather" ldi.exr -d float -o coarse-out.exr --holdout coarse.exr $how
    same coarse-out.exr fine-out.exr "a holdout of the picture's size $how"
    picture differ fine-out.exr out.exr || fail "--holdout $how has no effect"
done
card 20x24 40x24 other.exr
fails_saying 1 'other.exr: its display window differs' "$bin/dof-gather" ldi.exr -o x.exr --holdout other.exr

# An element over nothing that ends within a pixel covers half of it, with and without a lens.
picture make element.exr 13x12+40+30 frame=100x80 R=0.5 G=0.25 B=1 A=1 Z=2
exits 0 "$bin/dof-gather" element.exr -o half.exr --lens-radius 0 --supersample 2 -d float
expect_window half.exr dataWindow '(20 15) - (26 20)'
[ "$(picture pixel half.exr 26,17 R,A)" = "0.25 0.5" ] || fail "an edge within a pixel: $(picture pixel half.exr 26,17 R,A)"
lens=(--focal-length 50 --sensor-width 36 --lens-radius 0.05 --focus-distance 4)
exits 0 "$bin/dof-gather" element.exr -o blurred.exr "${lens[@]}" --supersample 2 -d float
awk -v a="$(picture sum blurred.exr A)" 'BEGIN { exit !(a > 38 && a < 40) }' || fail "light is lost: $(picture sum blurred.exr A) of 39"

# Mattes: the coverage of an id is a mean, but ids are not. Data and ids come from one sub-pixel. For each eye.
names=R,G,B,A,Z,CryptoObject00.R,CryptoObject00.G,IndexOB.X,N.X
oiiotool --pattern constant:color=1,0,0,1,2,2.5e38,1,7,0.75 13x16 9 --chnames $names -d float -o left.exr
oiiotool left.exr --pattern constant:color=0,1,0,1,6,1.5,1,3,-0.5 24x16 9 --chnames $names --paste +0+0 -d float -o ids.exr
exits 0 "$bin/dof-gather" ids.exr -o ids-out.exr --lens-radius 0 --supersample 2 -d float
expect_window ids-out.exr displayWindow '(0 0) - (11 7)'
edge=$(picture pixel ids-out.exr 6,4 R,G,A,CryptoObject00.G,N.X,IndexOB.X)
[ "$edge" = "0.5 0.5 1 0.5 -0.5 3" ] || fail "at the edge: $edge"
edge=$(picture pixel ids-out.exr 5,4 R,G,A,CryptoObject00.R,CryptoObject00.G,N.X,IndexOB.X)
[ "$edge" = "1 0 1 2.50000007e+38 1 0.75 7" ] || fail "beside the edge: $edge"
for eye in left right; do oiiotool ldi.exr --flatten --ch R,G,B,A,Z --attrib:type=string view $eye -d float -o $eye.exr; done
oiiotool left.exr right.exr --siappendall -o stereo.exr
exits 0 "$bin/dof-gather" stereo.exr -o eye.%V.exr --stereo-view all --lens-radius 0 --supersample 2
expect_window eye.left.exr displayWindow '(0 0) - (79 47)'
expect_window eye.right.exr displayWindow '(0 0) - (79 47)'

# Figures by region: regions of the picture, from the LDI of its sub-pixels.
exits 0 "$bin/dof-compare" out.exr views/reference.exr --regions ldi.exr --json
grep -q silhouettes stdout || fail "dof-compare --regions: $(cat stdout)"
