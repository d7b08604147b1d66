# Which pixels are made, and at which size: --region, --proxy, --overscan. And --holdout, which is placed by its depth.
#   bash windows.sh BIN_DIR
. "$(dirname "$0")/check.sh"
window() { exrheader "$1" | sed -nE "s/^$2 \(type box2i\): //p"; } # FILE dataWindow|displayWindow
same() { picture same "$1" "$2" >found || fail "$3 ($(cat found))"; }
expect_window() { [ "$(window "$1" "$2")" = "$3" ] || fail "$1: $2 $(window "$1" "$2"), not $3"; }

exits 0 "$bin/dof-trace" fence --size 160x96 --views 0 --spp 2 --overscan 8 -o views
exits 0 "$bin/ldi-warp" views/center.exr -o ldi.exr
exits 0 "$bin/dof-gather" ldi.exr -o full.exr
expect_window full.exr dataWindow '(-8 -8) - (167 103)'
expect_window full.exr displayWindow '(0 0) - (159 95)'

# A picture that fills its display window is the same with and without growth. --overscan crop: the display window.
for overscan in keep grow; do
    exits 0 "$bin/dof-gather" ldi.exr -o $overscan.exr --overscan $overscan
    cmp -s $overscan.exr full.exr || fail "--overscan $overscan"
done
exits 0 "$bin/dof-gather" ldi.exr -o crop.exr --overscan crop
expect_window crop.exr dataWindow '(0 0) - (159 95)'
picture edit full.exr expected.exr crop=160x96
same crop.exr expected.exr "--overscan crop"

# --region: the same pixels, and only those; depth too.
for method in lens selective; do
    exits 0 "$bin/dof-gather" ldi.exr -o whole.exr --method $method
    exits 0 "$bin/dof-gather" ldi.exr -o region.exr --method $method --region 70,20,99,200 --depth-out depth.exr
    expect_window region.exr dataWindow '(70 20) - (99 103)'
    expect_window region.exr displayWindow '(0 0) - (159 95)'
    expect_window region.exr sparselens:dataWindow ''
    expect_window depth.exr dataWindow '(70 20) - (99 103)'
    picture edit whole.exr expected.exr crop=30x84+70+20
    same region.exr expected.exr "--region, $method"
done
for box in 1,2,3 a,b,c,d 5,5,4,9 1,2,3,4,5 ''; do
    fails_saying 2 '--region' "$bin/dof-gather" ldi.exr -o x.exr --region "$box"
done
fails_saying 2 'region contains no pixel' "$bin/dof-gather" ldi.exr -o x.exr --region 500,500,600,600

# --proxy: without a lens the mean of the pixels; with one, the mean of the large picture, except for the coarser
# samples.
exits 0 "$bin/dof-gather" ldi.exr -o flat.exr --lens-radius 0 -d float
exits 0 "$bin/dof-gather" ldi.exr -o small.exr --lens-radius 0 -d float --proxy 2
expect_window small.exr dataWindow '(-4 -4) - (83 51)'
expect_window small.exr displayWindow '(0 0) - (79 47)'
oiiotool flat.exr --crop 0,0,159,95 --resize:filter=box 80x48 --ch R,G,B -o expected.exr
picture edit small.exr cut.exr crop=80x48 channels=R,G,B
picture same cut.exr expected.exr 2e-4 >found || fail "--proxy 2 is not the mean ($(cat found))"
exits 0 "$bin/dof-gather" ldi.exr -o small.exr --proxy 2 --overscan crop
oiiotool full.exr --crop 0,0,159,95 --resize:filter=box 80x48 -o expected.exr
exits 0 "$bin/dof-compare" small.exr expected.exr --json
psnr=$(sed -nE 's/.*"psnr_tonemapped": *([0-9.]+).*/\1/p' stdout | head -1)
[ "${psnr%.*}" -ge 30 ] || fail "--proxy 2 is $psnr dB from the reduced picture"
fails_saying 2 '--proxy' "$bin/dof-gather" ldi.exr -o x.exr --proxy 0

# --overscan: an element with a tight data window in an empty frame keeps its light and the shape of its blur, unless
# its pixels are kept. It grows by its own blur; a sharp element does not grow.
picture make element.exr 12x12+40+30 frame=100x80 R=0.5 G=0.25 B=1 A=1 Z=2
focal=(--focal-length 50 --sensor-width 36 -d float)
lens=("${focal[@]}" --lens-radius 0.05 --focus-distance 4) # CoC 1.7 px of 100
exits 0 "$bin/dof-gather" element.exr -o tight.exr "${lens[@]}" --overscan keep
expect_window tight.exr dataWindow '(40 30) - (51 41)'
exits 0 "$bin/dof-gather" element.exr -o grown.exr "${lens[@]}" --depth-out depth.exr
expect_window grown.exr dataWindow '(37 27) - (54 44)'
expect_window depth.exr dataWindow '(37 27) - (54 44)'
exits 0 "$bin/dof-gather" element.exr -o named.exr "${lens[@]}" --overscan grow
cmp -s grown.exr named.exr || fail "--overscan grow is not the default"
light=$(picture sum grown.exr A) # of 144 pixels
awk -v a="$light" 'BEGIN { exit !(a >= 142 && a <= 146) }' || fail "--overscan grow does not keep the light: $light"
exits 0 "$bin/dof-gather" element.exr -o sharp.exr "${focal[@]}" --lens-radius 0.05 --focus-distance 2
expect_window sharp.exr dataWindow '(40 30) - (51 41)'
exits 0 "$bin/dof-gather" element.exr -o sharp.exr --lens-radius 0
expect_window sharp.exr dataWindow '(40 30) - (51 41)'
exits 0 "$bin/dof-gather" element.exr -o grown.exr "${focal[@]}" --lens-radius 5 --focus-distance 4 # CoC 174 px: all of the display window
expect_window grown.exr dataWindow '(0 0) - (99 79)'
for method in selective scatter; do
    exits 0 "$bin/dof-gather" element.exr -o grown.exr "${lens[@]}" --method $method
    expect_window grown.exr dataWindow '(37 27) - (54 44)'
done

# -v reports how much overscan a picture needs. Without -v it is reported if the disc of a lamp is cut off.
picture make wall.exr 40x20 R=0.5 G=0.5 B=0.5 A=1 Z=20
wide=(--focal-length 50 --sensor-width 36 --lens-radius 0.5 --focus-distance 4) # CoC 5.6 px of 40
exits 0 "$bin/dof-gather" wall.exr -o x.exr "${wide[@]}" -v
grep -qx 'dof-gather: wall.exr: the blur reaches 6 pixels beyond the frame, and 0 were rendered there' stderr || fail "-v: $(cat stderr)"
exits 0 "$bin/ldi-warp" wall.exr -o x.exr "${wide[@]}" -v
grep -q 'the blur reaches 6 pixels beyond the frame' stderr || fail "ldi-warp -v: $(cat stderr)"
exits 0 "$bin/dof-gather" wall.exr -o x.exr "${wide[@]}"
[ ! -s stderr ] || fail "a plain wall is complained of: $(cat stderr)"
picture edit wall.exr lamp.exr fill=1x1+0+7 R=90 G=90 B=90
for tool in dof-gather ldi-warp; do
    exits 0 "$bin/$tool" lamp.exr -o x.exr "${wide[@]}"
    grep -q 'warning: .* discs of lights outside the frame are missing' stderr || fail "$tool: no warning: $(cat stderr)"
done
# In a range of frames it is reported once, and for the others with -v.
exits 0 "$bin/dof-gather" lamp.exr -o lamp.#.exr --frames 1-3 "${wide[@]}"
[ "$(grep -c 'warning: .* discs of lights outside the frame are missing' stderr)" -eq 1 ] || fail "not one warning: $(cat stderr)"
exits 0 "$bin/dof-gather" lamp.exr -o lamp.#.exr --frames 1-3 "${wide[@]}" -v
[ "$(grep -c 'warning: .* discs of lights outside the frame are missing' stderr)" -eq 1 ] &&
    [ "$(grep -c 'dof-gather: lamp.exr: .* discs of lights outside the frame are missing' stderr)" -eq 2 ] ||
    fail "-v does not say it of each frame: $(cat stderr)"
rm x.exr lamp.*.exr

# --holdout: things behind it disappear, at its edge from one pixel to the next; things in front stay.
picture make wall.exr 40x20 R=0.5 G=0.5 B=0.5 A=1 Z=20
oiiotool --pattern constant:color=1,0,0,1,3 20x20 5 --chnames R,G,B,A,Z --fullsize 40x20 -d float --deepen -o card.exr
exits 0 "$bin/dof-gather" wall.exr -o free.exr "${lens[@]}"
exits 0 "$bin/dof-gather" wall.exr -o held.exr "${lens[@]}" --holdout card.exr
picture edit free.exr expected.exr fill=20x20 R=0 G=0 B=0 A=0
picture same held.exr expected.exr 1e-5 >found || fail "--holdout ($(cat found))"
exits 0 "$bin/dof-gather" wall.exr -o held.exr --lens-radius 0 -d float --holdout card.exr
picture edit wall.exr expected.exr channels=R,G,B,A fill=20x20 R=0 G=0 B=0 A=0
same held.exr expected.exr "--holdout without a lens"
exits 0 "$bin/dof-gather" card.exr -o front.exr "${lens[@]}"
exits 0 "$bin/dof-gather" card.exr -o held.exr "${lens[@]}" --holdout wall.exr
same held.exr front.exr "--holdout hides what is in front of it"
fails_saying 2 '--holdout' "$bin/dof-gather" wall.exr -o x.exr "${lens[@]}" --holdout card.exr --method scatter
fails_saying 1 'element.exr.*display window' "$bin/dof-gather" wall.exr -o x.exr "${lens[@]}" --holdout element.exr

# --holdout-defocused: the holdout is blurred as in the scene of both; here it is black, so the colours equal that
# scene's.
oiiotool card.exr --flatten --ch R,G,B,A,Z --mulc 0,0,0,1,1 --deepen -o black.exr
exits 0 "$bin/ldi-cluster" wall.exr black.exr -o both.exr --tolerance 0 --focal-length 50 --sensor-width 36 --lens-radius 0.05
exits 0 "$bin/dof-gather" both.exr -o expected.exr "${lens[@]}" --channels R,G,B
exits 0 "$bin/dof-gather" wall.exr -o held.exr "${lens[@]}" --holdout card.exr --holdout-defocused --channels R,G,B
picture same held.exr expected.exr 1e-5 >found || fail "--holdout-defocused ($(cat found))"
fails_saying 2 'holdout' "$bin/dof-gather" wall.exr -o x.exr "${lens[@]}" --holdout-defocused
[ ! -e x.exr ] || fail "a failure wrote x.exr"

# A display window of billions of pixels around a few: a small file must not make anything that fills it.
picture make vast.exr 16x16 frame=60000x60000 R=0.5 G=0.5 B=0.5 A=1 Z=4
vast() { "$bin/dof-gather" vast.exr --focal-length 50 --sensor-width 36 --focus-distance 2 "$@"; }
exits 0 vast --lens-radius 0.1 --overscan keep -o x.exr
exits 0 vast --lens-radius 0.001 -o x.exr
fails_saying 1 'vast.exr.*memory.*--max-memory.*--overscan keep' vast --lens-radius 0.1 -o grown.exr
fails_saying 1 'x.png.*memory.*--max-memory' vast --lens-radius 0.1 --overscan keep -o x.png
