#!/bin/bash
# ldi-warp --denoised: removes the views' noise and keeps lamps; pictures that do not fit are refused in one line. The
# denoiser is a mean over a square.
. "$(dirname "$0")/check.sh"
command -v oiiotool >/dev/null || skip "needs oiiotool (openimageio-tools)"

# denoise FOLDER: denoises each view of it into FOLDER/NAME.denoised.exr.
denoise() {
    local view
    for view in "$1"/center.exr "$1"/view_?.exr; do
        oiiotool "$view" --dup --ch R,G,B --blur:kernel=box 5x5 -o "${view%.exr}.denoised.exr"
    done
}
# decibels FOLDER WARP_OPTION...: of the gathered picture.
decibels() {
    "$bin/ldi-warp" "$1"/center.exr "$1"/view_?.exr "${@:2}" -o ldi.exr 2>stderr || fail "$(cat stderr)"
    "$bin/dof-gather" ldi.exr -o picture.exr 2>stderr || fail "$(cat stderr)"
    "$bin/dof-compare" picture.exr "$1/reference.exr" | awk '$1 == "psnr_tonemapped" { print $2 }'
}
above() { awk "BEGIN { exit !($1 > $2) }" || fail "$3: $1 dB, not above $2"; }

views=({center,view_0,view_1,view_2,view_3}.exr) denoised=({center,view_0,view_1,view_2,view_3}.denoised.exr)
for scene in grass lamps; do
    exits 0 "$bin/dof-trace" $scene --size 96x54 --light area --views 4 --spp 1 --reference 256 -o $scene
    denoise $scene
    noisy=$(decibels $scene)
    found=$(decibels $scene --denoised "${denoised[@]/#/$scene/}")
    case $scene in
    grass) above "$found" "$(awk "BEGIN { print $noisy + 1 }")" "grass, which is noisy" ;;
    lamps) above "$found" "$(awk "BEGIN { print $noisy - 0.1 }")" "lamps, which are no noise" ;;
    esac
done

cd grass
exits 0 "$bin/ldi-warp" "${views[@]}" -o plain.ldi.exr
exits 0 "$bin/ldi-warp" "${views[@]}" --denoised "${views[@]}" -o itself.ldi.exr
cmp -s plain.ldi.exr itself.ldi.exr || fail "views that nobody denoised do not stay as they are"
for view in center view_0; do
    cp $view.exr $view.0007.exr
    cp $view.denoised.exr $view.denoised.0007.exr
done
exits 0 "$bin/ldi-warp" center.exr view_0.exr --denoised center.denoised.exr view_0.denoised.exr -o still.ldi.exr
exits 0 "$bin/ldi-warp" center.####.exr view_0.####.exr --denoised center.denoised.####.exr view_0.denoised.####.exr --frames 7 -o frame.####.ldi.exr
cmp -s still.ldi.exr frame.0007.ldi.exr || fail "a frame is not what the same still is"

# One file with both pictures, as Cycles writes it, is as good as two files.
for view in "${views[@]}"; do
    oiiotool ${view%.exr}.denoised.exr "$view" --ch "Noisy Image.R=R,Noisy Image.G=G,Noisy Image.B=B" --chappend "$view" --ch A,Z --chappend -o both.$view
done
exits 0 "$bin/ldi-warp" "${views[@]}" --denoised "${denoised[@]}" -o two.ldi.exr
exits 0 "$bin/ldi-warp" "${views[@]/#/both.}" --noisy 'Noisy Image' -o one.ldi.exr
picture same two.ldi.exr one.ldi.exr R,G,B,A,Z 5e-4 || fail "a file of both gives another LDI than two files" # oiiotool made floats
fails_saying 1 'both.center.exr: has no channel Noise.R: render' "$bin/ldi-warp" both.center.exr both.view_0.exr --noisy Noise -o no.exr

# Windows that do not begin at 0,0: the light of a crop is that of the whole view, away from its edges.
oiiotool center.denoised.exr --crop 60x30+20+12 -o cropped.denoised.exr
oiiotool center.exr --crop 60x30+20+12 -o cropped.exr
exits 0 "$bin/ldi-warp" center.exr --denoised center.denoised.exr -o whole.ldi.exr
exits 0 "$bin/ldi-warp" cropped.exr --denoised cropped.denoised.exr -o cropped.ldi.exr
for ldi in whole cropped; do
    exits 0 "$bin/dof-gather" $ldi.ldi.exr --lens-radius 0 -o $ldi.flat.exr
    picture edit $ldi.flat.exr $ldi.middle.exr crop=20x6+40+24
done
picture same whole.middle.exr cropped.middle.exr R,G,B 5e-4 || fail "a denoised crop is another picture"

oiiotool center.exr --ch R,G,B --resize 48x27 -o small.exr
oiiotool center.exr --ch A,Z -o colourless.exr
fails_saying 2 '--denoised: there are 2 of them for 5 views' "$bin/ldi-warp" "${views[@]}" --denoised "${denoised[@]:0:2}" -o no.exr
fails_saying 1 'small.exr: its windows are not those of center.exr' "$bin/ldi-warp" center.exr --denoised small.exr -o no.exr
fails_saying 1 'colourless.exr' "$bin/ldi-warp" center.exr --denoised colourless.exr -o no.exr
fails_saying 1 'no-such.exr' "$bin/ldi-warp" center.exr --denoised no-such.exr -o no.exr
fails_saying 1 'plain.ldi.exr' "$bin/ldi-warp" center.exr --denoised plain.ldi.exr -o no.exr
[ ! -e no.exr ] || fail "a file was left behind"
