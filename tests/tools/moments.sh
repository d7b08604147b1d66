#!/bin/bash
# The moments of a shutter: names with %s, one picture of several LDIs, and what is refused.
. "$(dirname "$0")/check.sh"
. "$source_dir/tests/tools/deep.sh"
gather=$bin/dof-gather

# Views of two frames, four moments each: the camera of a fence moves forward.
for frame in 1 2; do
    for moment in 0 1 2 3; do
        exits 0 "$bin/dof-trace" fence --size 96x54 --spp 1 --dolly 0.$((frame * 4 + moment)) -o traced
        for view in center view_0 view_1 view_2 view_3; do
            mv traced/$view.exr $view.000${frame}_$moment.exr
        done
    done
done
warp=("$bin/ldi-warp" "center.####_%s.exr" "view_0.####_%s.exr" "view_1.####_%s.exr" "view_2.####_%s.exr" "view_3.####_%s.exr")

# One command warps all moments of all frames, with the frames that are given or those on disk.
exits 0 "${warp[@]}" -o "ldi.####_%s.exr" --frames 1-2
exits 0 "${warp[@]}" -o "again/ldi.####_%s.exr"
exits 0 "$bin/ldi-warp" center.0002_1.exr view_{0..3}.0002_1.exr -o one.exr
same ldi.0002_1.exr one.exr "a moment of a frame"
same again/ldi.0002_3.exr ldi.0002_3.exr "frames on disk"
[ "$(find . -name 'ldi.000?_?.exr' -printf x | wc -c)" -eq 16 ] || fail "not 8 LDIs: $(ls . again)"
fails_saying 2 'center.0001_%s.exr: %s stands for the number of a moment: put it into the name of the output' \
    "${warp[@]}" -o "ldi.####.exr" --frames 1-2
exits 0 "$bin/ldi-warp" center.0001_0.exr view_0.0001_0.exr -o "x_%s.exr"
[ -e "x_%s.exr" ] || fail "without moments, %s does not stand for itself: $(ls x_*)"
rm "x_%s.exr"

# One picture of each frame. It is not that of a moment, and the same on any number of threads.
exits 0 "$gather" "ldi.####_%s.exr" -o "picture.####.exr" --stats stats.json
[ "$(grep -c '"moments":4' stats.json)" -eq 2 ] || fail "the moments are not counted: $(cat stats.json)"
exits 0 "$gather" ldi.0002_%s.exr -o one.exr --threads 1
same picture.0002.exr one.exr "one thread"
exits 0 "$gather" ldi.0002_2.exr -o still.exr
differ picture.0002.exr still.exr "motion blur"
! exrheader picture.0002.exr | grep -q sparselens:moment || fail "the picture says that it is a moment"

# It is the mean of what its moments show through the whole lens, but for the number of lens points.
exits 0 "$gather" "ldi.0002_%s.exr" -o "each_%s.exr"
oiiotool each_0.exr each_1.exr --add each_2.exr --add each_3.exr --add --mulc 0.25 -o mean.exr
exits 0 "$bin/dof-compare" picture.0002.exr mean.exr
awk '$1 == "psnr_tonemapped" { exit !($2 > 40) }' stdout || fail "far from the mean of its moments: $(cat stdout)"

# Options of the lens hold for all moments; a curve weights them; depth is that of the middle moment.
exits 0 "$gather" "ldi.0002_%s.exr" -o near.exr --focus-pixel 48,27 -v
[ "$(grep -c 'the focus distance is' stderr)" -eq 1 ] || fail "each moment has its own focus: $(cat stderr)"
exits 0 "$bin/dof-gather" "ldi.0002_%s.exr" -o last.exr --shutter-curve <(printf '0 0\n0.75 0\n0.7501 1\n1 1\n') --lens-radius 0
exits 0 "$gather" ldi.0002_3.exr -o only.exr --lens-radius 0
picture same last.exr only.exr R,G,B,A 0.002 >found || fail "a curve of the last moment: $(cat found)"
exits 0 "$gather" "ldi.0002_%s.exr" -o one.exr --depth-out depth.exr
exits 0 "$gather" ldi.0002_2.exr -o still.exr --depth-out still-depth.exr
picture same depth.exr still-depth.exr >found || fail "the depth: $(cat found)"
fails_saying 2 '^dof-gather: --shutter-curve: needs the moments of a shutter' \
    "$gather" ldi.0002_2.exr -o x.exr --shutter-curve box

# A rolling shutter: the top row shows the first moment, and the bottom row the last.
exits 0 "$gather" "ldi.0002_%s.exr" -o together.exr --rolling-shutter 1
same together.exr one.exr "all rows together"
exits 0 "$bin/dof-gather" "ldi.0002_%s.exr" -o rolling.exr --rolling-shutter 0.2 --lens-radius 0
exits 0 "$gather" ldi.0002_0.exr -o first.exr --lens-radius 0
for row in "0 first.exr" "53 only.exr"; do
    read -r y moment <<<"$row"
    for name in rolling.exr "$moment"; do oiiotool "$name" --cut 96x1+0+"$y" -o "row.$name"; done
    picture same row.rolling.exr "row.$moment" R,G,B,A 0.002 >found || fail "--rolling-shutter: row $y: $(cat found)"
done
picture same rolling.exr first.exr R,G,B,A 0.002 >found && fail "--rolling-shutter: all rows show the first moment"
fails_saying 2 '^dof-gather: --rolling-shutter: needs the moments of a shutter' \
    "$gather" ldi.0002_2.exr -o x.exr --rolling-shutter 0.5
for wrong in 0 -1 1.01 inf nan top; do
    fails_saying 2 '^dof-gather: --rolling-shutter: .* is not a number from 0.001 to 1' \
        "$gather" "ldi.0002_%s.exr" -o x.exr --rolling-shutter $wrong
done
fails_saying 1 'no-such-curve' "$gather" "ldi.0002_%s.exr" -o x.exr --shutter-curve no-such-curve

# An output that is an input.
fails_saying 2 'would overwrite the input ldi.0002_1.exr' "$gather" "ldi.0002_%s.exr" -o ldi.0002_1.exr

# Moments that are missing, or of another shot.
mv ldi.0002_1.exr away.exr
fails_saying 1 'ldi.0002_%s.exr: the moments must be numbered without a gap, and there are 0, 2, 3' \
    "$gather" "ldi.0002_%s.exr" -o x.exr
fails_saying 1 'none_%s.exr: there is no such file; %s stands for the number of a moment' "$gather" none_%s.exr -o x.exr
exits 0 "$bin/dof-trace" fence --size 80x54 --spp 1 --views 0 -o traced
exits 0 "$bin/ldi-warp" traced/center.exr -o ldi.0002_1.exr
fails_saying 1 'ldi.0002_1.exr: its size of 80x54 is another than ldi.0002_2.exr' "$gather" "ldi.0002_%s.exr" -o x.exr
[ ! -e x.exr ] || fail "a picture of different shots"
