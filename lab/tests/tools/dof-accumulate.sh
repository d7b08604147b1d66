#!/bin/bash
# dof-accumulate from the shell: closed forms with one lamp, what each option changes, and a traced scene.
. "$(dirname "$0")/../../../tests/tools/check.sh"
command -v oiiotool >/dev/null || skip "needs oiiotool (openimageio-tools)"
accumulate=$bin/dof-accumulate

# lamp FILE X Y: 64x48, black, one pixel of value 5, and a depth.
lamp() {
    picture make "$1" 64x48 R=0 G=0 B=0 A=0 Z=0 fill=1x1+$2+$3 R=5 G=5 B=5 A=1 Z=7 half=R,G,B,A
}
# value FILE X Y: prints channel R.
value() {
    picture pixel "$1" "$2,$3" R
}
# holds FILE X Y EXPECTED
holds() {
    local v
    v=$(value "$1" "$2" "$3")
    awk -v a="$v" -v b="$4" 'BEGIN { exit !(a != "" && a - b < 2e-6 && b - a < 2e-6) }' ||
        fail "$1 ($2, $3) is $v, not $4"
}

answers_help dof-accumulate VIEW.exr -o OUT.exr

# F = 64 pixels; focused at 2, a view 1/8 from the centre is displaced by 4 pixels there. The lamp is in the plane of
# focus.
lens=(--focal-length 36 --sensor-width 36 --focus-distance 2)
lamp center.exr 32 24
lamp right.exr 28 24
lamp left.exr 36 24
lamp up.exr 32 28
lamp down.exr 32 20
views=(--view 0,0 center.exr --view 0.125,0 right.exr --view -0.125,0 left.exr
    --view 0,0.125 up.exr --view 0,-0.125 down.exr)
exits 0 "$accumulate" "${views[@]}" "${lens[@]}" -o out.exr
[ ! -s stderr ] || fail "says on stderr: $(cat stderr)"
holds out.exr 32 24 5
holds out.exr 31 24 0
oiiotool --info -v out.exr | grep -q 'channel list: R, G, B, A$' || fail "other channels than R, G, B, A"
oiiotool --info out.exr | grep -q '4 channel, half' || fail "not half"

# With another focus the lamp becomes five lamps.
exits 0 "$accumulate" "${views[@]}" --focal-length 36 --sensor-width 36 --focus-distance inf -o inf.exr
holds inf.exr 32 24 1
holds inf.exr 28 24 1
holds inf.exr 32 28 1
# The other lens options scale the displacement.
exits 0 "$accumulate" "${views[@]}" --focal-length 18 --sensor-width 36 --focus-distance 2 -o focal.exr
holds focal.exr 30 24 1
exits 0 "$accumulate" "${views[@]}" --focal-length 36 --sensor-width 72 --focus-distance 2 -o sensor.exr
holds sensor.exr 32 26 1
exits 0 "$accumulate" "${views[@]}" --focal-length 36 --sensor-width 36 --focus-distance 4 -o far.exr
holds far.exr 34 24 1

# A smaller aperture leaves out the views beyond it.
views+=(--view 0.25,0 center.exr)
exits 0 "$accumulate" "${views[@]}" "${lens[@]}" -v -o wide.exr
grep -q '6 views' stderr || fail "-v does not count the views: $(cat stderr)"
exits 0 "$accumulate" "${views[@]}" "${lens[@]}" --lens-radius 0.125 -v -o out.exr
grep -q '5 views' stderr || fail "--lens-radius leaves nothing out: $(cat stderr)"
exits 0 "$accumulate" "${views[@]}" "${lens[@]}" --fstop 1 -v -o out.exr # 0.018 scene units
grep -q '1 views' stderr || fail "--fstop leaves nothing out: $(cat stderr)"
exits 0 "$accumulate" "${views[@]}" "${lens[@]}" --fstop 1 --scene-unit 0.1 -v -o out.exr # 0.18
grep -q '5 views' stderr || fail "--scene-unit changes nothing: $(cat stderr)"
exits 0 "$accumulate" "${views[@]}" --lens-radius 0 -o out.exr # needs no other value
holds out.exr 32 24 5
fails_saying 1 'all views lie outside the aperture' "$accumulate" --view 1,0 left.exr "${lens[@]}" --lens-radius 0.5 -o none.exr

# Types, windows, ids, standard streams, threads.
exits 0 "$accumulate" "${views[@]:0:9}" "${lens[@]}" -d float -o third.exr
oiiotool --info third.exr | grep -q '4 channel, float' || fail "-d float does not write float"
picture edit center.exr crop.exr crop=16x48+24+0
exits 0 "$accumulate" --view 0,0 center.exr --view 0.125,0 crop.exr "${lens[@]}" --outside unknown -d float -o out.exr
holds out.exr 50 24 0
holds out.exr 32 24 2.5
picture make white.exr 64x48 R=1 G=1 B=1 A=1
picture edit white.exr white_crop.exr crop=16x48+24+0
exits 0 "$accumulate" --view 0,0 white.exr --view 0,0 white_crop.exr "${lens[@]}" -d float -o out.exr
holds out.exr 50 24 1
exits 0 "$accumulate" --view 0,0 white.exr --view 0,0 white_crop.exr "${lens[@]}" --outside transparent -d float -o out.exr
holds out.exr 50 24 0.5
holds out.exr 30 24 1
"$accumulate" --view 0,0 - --view 0.125,0 right.exr "${lens[@]}" -o - <center.exr >piped.exr || fail "cannot be piped"
holds piped.exr 32 24 5
exits 0 "$accumulate" "${views[@]}" --focal-length 36 --sensor-width 36 --focus-distance 3.3 --threads 1 -d float -o one.exr
exits 0 "$accumulate" "${views[@]}" --focal-length 36 --sensor-width 36 --focus-distance 3.3 --threads 2 -d float -o two.exr
picture same one.exr two.exr || fail "threads change the picture"

# A non-finite value is filled and reported.
picture edit center.exr overflow.exr float= fill=1x1+32+24 R=inf
exits 0 "$accumulate" --view 0,0 center.exr --view 0,0 overflow.exr "${lens[@]}" -d float -o out.exr
grep -q 'warning: overflow.exr: 1 values' stderr || fail "no warning of bad values: $(cat stderr)"
holds out.exr 32 24 2.5

# Wrong usage. A failure leaves no picture behind.
rm -f none.exr
fails_saying 2 'no views' "$accumulate" "${lens[@]}" -o none.exr
fails_saying 2 output "$accumulate" center.exr
fails_saying 2 "must be X,Y.*'1;2'" "$accumulate" --view '1;2' center.exr "${lens[@]}" -o none.exr
fails_saying 2 'focus distance.*--focus-distance' "$accumulate" "${views[@]}" --focal-length 36 --sensor-width 36 -o none.exr
fails_saying 2 'focal length.*--focal-length' "$accumulate" "${views[@]}" -o none.exr
fails_saying 2 'center.exr.*worldToCamera.*--view' "$accumulate" center.exr left.exr "${lens[@]}" -o none.exr
fails_saying 2 'half' "$accumulate" "${views[@]}" "${lens[@]}" -d int -o none.exr
fails_saying 1 'missing.exr' "$accumulate" --view 0,0 missing.exr "${lens[@]}" -o none.exr
picture edit center.exr rgb.exr channels=R,G,B
fails_saying 1 'rgb.exr: has no channel A' "$accumulate" --view 0,0 center.exr --view 0.1,0 rgb.exr "${lens[@]}" -o none.exr
picture edit center.exr other.exr frame=60x48
fails_saying 1 'other.exr.*display window' "$accumulate" --view 0,0 center.exr --view 0,0 other.exr "${lens[@]}" -o none.exr
[ ! -e none.exr ] || fail "a failed run left a picture"

# Cameras from the metadata; the lens centre from --center.
exits 0 "$bin/dof-trace" fence -o fence --views 2 --lens-views 8 --spp 1 --size 48x27 --lens-radius 0.06
exits 0 "$accumulate" fence/lens_*.exr --center fence/center.exr -o centered.exr
[ ! -s stderr ] || fail "warns although --center is given: $(cat stderr)"
exits 0 "$accumulate" fence/lens_*.exr -o guessed.exr
grep -q 'warning: .*--center' stderr || fail "does not say that the centre is guessed"
picture differ centered.exr guessed.exr || fail "--center changes nothing"
fails_saying 2 'left.exr.*worldToCamera' "$accumulate" fence/lens_*.exr --center left.exr -o none.exr

# Frusta that converge on the plane of focus: all see the lamp there in the same pixel. With another focus it moves as
# if they looked straight ahead, however the views' positions are given.
converging() { # FILE X NDC: a camera X to the right, whose optical axis meets the picture at NDC, 0 to 1
    oiiotool center.exr --attrib:type=matrix worldToCamera "1,0,0,0,0,1,0,0,0,0,1,0,$2,0,0,1" \
        --attrib:type=matrix worldToNDC "1,0,0,0,0,-1.3333333,0,0,$3,0.5,1,1,$2,0,-1,0" -o "$1"
}
converging to_right.exr -0.125 0.5625
converging to_left.exr 0.125 0.4375
converging middle.exr 0 0.5
for views in "to_right.exr to_left.exr --center middle.exr" "to_right.exr to_left.exr" \
    "--view 0.125,0 to_right.exr --view -0.125,0 to_left.exr"; do
    # shellcheck disable=SC2086
    exits 0 "$accumulate" $views "${lens[@]}" -o out.exr
    holds out.exr 32 24 5
    # shellcheck disable=SC2086
    exits 0 "$accumulate" $views --focal-length 36 --sensor-width 36 --focus-distance inf -o out.exr
    holds out.exr 28 24 2.5
    holds out.exr 36 24 2.5
done
oiiotool to_left.exr --attrib:type=matrix worldToNDC "1.1,0,0,0,0,-1.46667,0,0,0.4375,0.5,1,1,0.1375,0,-1,0" -o longer.exr
fails_saying 1 'longer.exr: its focal length differs' "$accumulate" to_right.exr longer.exr --center middle.exr "${lens[@]}" -o none.exr

# 64 views of 16 samples each are nearer to the truth than 64 rays per pixel through the lens. With overscan, so that
# the views see what the lens sees beyond the border.
trace() { exits 0 "$bin/dof-trace" fence -o "$1" --views 0 --size 96x54 "${@:2}"; }
trace truth --reference 1024
trace rays --reference 64
trace views --lens-views 64 --overscan 8
psnr_of() { "$bin/dof-compare" "$1" truth/reference.exr --json | sed -n 's/^  "psnr_tonemapped": \(.*\),/\1/p'; }
exits 0 "$accumulate" views/lens_*.exr --center views/center.exr -o average.exr
by_views=$(psnr_of average.exr) by_rays=$(psnr_of rays/reference.exr)
awk -v a="$by_views" -v b="$by_rays" 'BEGIN { exit !(b > 30 && a > b) }' ||
    fail "64 views: $by_views dB, 64 rays a pixel: $by_rays dB"
echo "dof-accumulate: fine ($by_views dB; 64 rays a pixel: $by_rays dB)"
