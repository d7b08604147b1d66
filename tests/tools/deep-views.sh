#!/bin/bash
# ldi-warp with deep views: alone they stay as they are, flat views add hidden surfaces, and unsupported views are
# refused.
# bash deep-views.sh BIN_DIR
. "$(dirname "$0")/check.sh"

same() { picture same "$@" >found 2>&1 || fail "$1 and $2 differ: $(cat found)"; }
# flattened DEEP: writes flat.exr.
flattened() { exits 0 "$bin/dof-gather" "$1" --lens-radius 0 -o flat.exr; }
samples() { picture samples "$1" | cut -d ' ' -f 1; }

for scene in mist grass; do
    exits 0 "$bin/dof-trace" $scene --size 128x72 --spp 16 --reference 256 --deep visible --deep views -o $scene
    deep=$scene/deep_visible.exr
    flattened $deep
    mv flat.exr centre.exr

    # Alone: tidy, with all channels of the file.
    exits 0 "$bin/ldi-cluster" $deep --tolerance 0 -o tidy.exr
    exits 0 "$bin/ldi-warp" $deep -o alone.exr
    names=R,G,B,A,Z
    [ $scene = grass ] || names=$names,ZBack
    same alone.exr tidy.exr $names
    [ "$(samples alone.exr)" -gt 12000 ] || fail "$scene: few samples"

    # With other views: surfaces that the centre view sees keep its coverage.
    for rim in "$scene/view_?.exr" "$scene/deep_view_?.exr"; do
        exits 0 "$bin/ldi-warp" $deep $rim --stats stats.json -o ldi.exr
        flattened ldi.exr
        same flat.exr centre.exr A 1e-3
        [ "$(samples ldi.exr)" -gt "$(samples alone.exr)" ] || fail "$scene: $rim adds nothing"
        exits 0 "$bin/ldi-warp" $deep $rim --merge keep -o kept.exr
        flattened kept.exr
        same flat.exr centre.exr R,G,B,A 1e-3
    done
done

# better PICTURE THAN BY: better by this many dB, compared with the scene's reference.
psnr() { "$bin/dof-compare" "$1" $scene/reference.exr | sed -n 's/^psnr_tonemapped *//p'; }
better() {
    local one two
    one=$(psnr "$1") two=$(psnr "$2")
    echo "$scene: $1 $one dB, $2 $two dB"
    awk "BEGIN { exit !($one >= $two + $3) }" || fail "$scene: $1 has $one dB, $2 $two"
}
for scene in mist grass; do
    exits 0 "$bin/ldi-warp" $scene/center.exr $scene/view_?.exr -o flat.ldi.exr
    exits 0 "$bin/ldi-warp" $scene/deep_visible.exr -o alone.ldi.exr
    exits 0 "$bin/ldi-warp" $scene/deep_visible.exr $scene/view_?.exr -o mixed.ldi.exr
    exits 0 "$bin/ldi-warp" $scene/deep_visible.exr $scene/deep_view_?.exr -o deep.ldi.exr
    for views in flat alone mixed deep; do exits 0 "$bin/dof-gather" $views.ldi.exr -o $views.exr; done
    better mixed.exr alone.exr -0.05 # in mist there is nothing to add
    better deep.exr flat.exr 0
done
better mixed.exr flat.exr 0 # grass is edges everywhere

# A flat centre view with deep rim views gives a warning; views that are already warped, or denoised, are refused.
exits 0 "$bin/ldi-warp" mist/center.exr mist/deep_view_0.exr -o ldi.exr
grep -q 'center.exr: is flat, and .*deep_view_0.exr is deep' stderr || fail "no warning: $(cat stderr)"
fails_saying 1 'mixed.ldi.exr: is an LDI' "$bin/ldi-warp" mixed.ldi.exr -o out.exr
fails_saying 1 'deep_visible.exr: is deep, and denoisers' "$bin/ldi-warp" mist/deep_visible.exr \
    --denoised mist/center.exr -o out.exr
[ ! -e out.exr ] || fail "an output of what was refused"
