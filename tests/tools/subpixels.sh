#!/bin/bash
# Sub-pixels combined with other features: files that disagree about them, windows that end within a pixel, each option
# of dof-gather that counts pixels.
#   bash subpixels.sh BIN_DIR
. "$(dirname "$0")/check.sh"
command -v oiiotool >/dev/null || skip "needs oiiotool (openimageio-tools)"
lab || skip "needs the laboratory (SPARSELENS_LAB)"
same() { picture same "$1" "$2" "${4:-0}" >found || fail "$3 ($(cat found))"; }
sum_is() { # FILE CHANNEL EXPECTED TOLERANCE WHAT
    awk -v a="$(picture sum "$1" "$2")" -v b="$3" -v d="$4" 'BEGIN { exit !(a >= b - d && a <= b + d) }' ||
        fail "$5: the sum of $2 is $(picture sum "$1" "$2"), not $3"
}
psnr_is() { # A B LEAST WHAT
    exits 0 "$bin/dof-compare" "$1" "$2" --json
    local psnr
    psnr=$(sed -nE 's/.*"psnr_tonemapped": *([0-9.]+).*/\1/p' stdout | head -1)
    awk -v a="$psnr" -v b="$3" 'BEGIN { exit !(a >= b) }' || fail "$4: $psnr dB, not $3"
}
lens=(--focal-length 50 --sensor-width 36 --lens-radius 0.05 --focus-distance 4)

# Files that disagree about the picture's pixels are not combined; an option can decide.
exits 0 "$bin/dof-trace" fence --size 80x48 --spp 4 --views 2 --supersample 2 -o fine
exits 0 "$bin/dof-trace" fence --size 160x96 --spp 1 --views 2 -o plain
views=(view_0.exr view_1.exr)
exits 0 "$bin/ldi-warp" fine/center.exr "${views[@]/#/fine/}" -o fine.exr
exits 0 "$bin/ldi-warp" plain/center.exr "${views[@]/#/plain/}" -o plain.exr
fails_saying 1 'plain.exr: 1 x 1 of its pixels .* 2 x 2 of fine.exr .*--supersample' "$bin/ldi-cluster" fine.exr plain.exr -o x.exr
fails_saying 1 'fine.exr: 2 x 2 of its pixels .* 1 x 1 of plain.exr' "$bin/ldi-cluster" plain.exr fine.exr -o x.exr
fails_saying 1 'plain/view_1.exr: 1 x 1 of its pixels .* 2 x 2 of fine/center.exr' \
    "$bin/ldi-warp" fine/center.exr fine/view_0.exr plain/view_1.exr -o x.exr
fails_saying 1 'fine/view_0.exr: 2 x 2 of its pixels .* 1 x 1 of plain/center.exr' \
    "$bin/ldi-warp" plain/center.exr --view 0.05,0 fine/view_0.exr -o x.exr
[ ! -e x.exr ] || fail "what was refused is written"
exits 0 "$bin/ldi-cluster" fine.exr plain.exr -o both.exr --supersample 2
exits 0 "$bin/ldi-cluster" plain.exr fine.exr -o swapped.exr --supersample 2
for file in both swapped; do exits 0 "$bin/dof-gather" $file.exr -o $file-out.exr -d float; done
same both-out.exr swapped-out.exr "two LDIs in either order" 1e-4

# The LDI is the same whether the files or the option give N, and so is the picture; an N that the warp did not know is
# refused.
for file in center "${views[@]%.exr}"; do oiiotool plain/$file.exr --eraseattrib ldi.supersample -o unsaid-$file.exr; done
for n in 2 4; do
    for file in center "${views[@]%.exr}"; do oiiotool plain/$file.exr --attrib:type=int ldi.supersample $n -o says-$file.exr; done
    exits 0 "$bin/ldi-warp" says-center.exr says-view_?.exr -o files.exr
    exits 0 "$bin/ldi-warp" unsaid-center.exr unsaid-view_?.exr -o option.exr --supersample $n
    same files.exr option.exr "N = $n"
    exits 0 "$bin/dof-gather" files.exr -o by-files.exr -d float
    exits 0 "$bin/dof-gather" option.exr -o by-option.exr -d float
    same by-files.exr by-option.exr "the picture by N = $n"
    exits 0 "$bin/ldi-plan" says-center.exr -o says.json
    exits 0 "$bin/ldi-plan" unsaid-center.exr -o option.json --supersample $n
    diff <(grep -v '"center"' says.json) <(grep -v '"center"' option.json) >found || fail "ldi-plan --supersample $n: $(cat found)"
done
fails_saying 2 'plain.exr: it was warped for pixels of 1 x 1, not of 4 x 4' "$bin/dof-gather" plain.exr -o x.exr --supersample 4
fails_saying 1 'made for a picture of another size' "$bin/dof-trace" fence --size 160x96 --plan says.json -o x # which says 4

# A focus pixel outside all pictures is an error, even if integer overflow would bring it inside.
oiiotool plain/center.exr --attrib:type=int ldi.supersample 16 -o sixteen.exr
for pixel in 268435456,0 -268435456,0 0,268435456; do
    fails_saying 2 '--focus-pixel: .* lies outside of sixteen.exr' "$bin/dof-gather" sixteen.exr -o x.exr --focus-pixel=$pixel
done

# A kept window that ends within a pixel covers half of it, and a wide filter carries its light beyond.
picture make element.exr 13x12+40+30 frame=100x80 R=0.5 G=0.25 B=1 A=1 Z=2
exits 0 "$bin/dof-gather" element.exr -o kept.exr -d float --lens-radius 0 --supersample 2 --overscan keep
exits 0 "$bin/dof-gather" element.exr -o grown.exr -d float --lens-radius 0 --supersample 2
[ "$(picture pixel kept.exr 26,17 R,A)" = "0.25 0.5" ] || fail "a kept edge: $(picture pixel kept.exr 26,17 R,A)"
sum_is kept.exr A 39 1e-4 "a kept window"
same kept.exr grown.exr "keep and grow without a lens" 1e-6
for overscan in keep crop grow; do
    exits 0 "$bin/dof-gather" element.exr -o wide.exr -d float --lens-radius 0 --supersample 2 --overscan $overscan \
        --pixel-filter blackman-harris:3
    sum_is wide.exr A 39 1e-3 "a wide filter with --overscan $overscan"
done

# Pictures of sub-pixels equal the mean of the large picture: with a holdout that begins within a pixel, with non-square
# pixels, with one view, and in bands.
large_and_small() { # IN OPTIONS...: small.exr, and expected.exr from the picture of all sub-pixels
    exits 0 "$bin/dof-gather" "$1" -d float -o large.exr --overscan crop --supersample 1 "${@:2}"
    oiiotool large.exr --resize:filter=box 80x48 -d float -o expected.exr
    exits 0 "$bin/dof-gather" "$1" -d float -o small.exr --overscan crop --supersample 2 "${@:2}"
}
oiiotool --pattern constant:color=1,0,0,1,3 81x55 5 --chnames R,G,B,A,Z --origin +1+1 --fullsize 160x96 -d float --deepen -o card.exr
large_and_small fine.exr --lens-radius 0 --holdout card.exr
same small.exr expected.exr "a holdout that ends within a pixel" 1e-5
exits 0 "$bin/dof-gather" fine.exr -d float -o without.exr --overscan crop --lens-radius 0
picture differ small.exr without.exr || fail "--holdout has no effect"
# Lamps are spread exactly, so lens points beyond those that sub-pixels need do not help. Discs with pixels twice as
# wide as high.
picture make lamps.exr 160x96 frame=160x96 R=0.1 G=0.1 B=0.1 A=1 Z=8 fill=1x1+50+40 R=900 fill=1x1+101+61 G=700
oiiotool lamps.exr --attrib:type=float PixelAspectRatio 2 -d float -o wide-lamps.exr
large_and_small wide-lamps.exr "${lens[@]}"
psnr_is small.exr expected.exr 50 "lamps in pixels that are not square"
large_and_small fine/center.exr
psnr_is small.exr expected.exr 40 "one view"

# --proxy counts the picture's pixels: half of it is a quarter of all sub-pixels.
exits 0 "$bin/dof-gather" fine.exr -d float -o proxy.exr --proxy 2
exits 0 "$bin/dof-gather" fine.exr -d float -o quarter.exr --proxy 4 --supersample 1
same proxy.exr quarter.exr "--proxy of sub-pixels"

# --show: circles of confusion are in the picture's pixels.
exits 0 "$bin/dof-trace" fence --size 80x48 --spp 4 -o small-view
for what in coc focus; do
    exits 0 "$bin/dof-gather" fine/center.exr -d float -o shown.exr --show $what
    exits 0 "$bin/dof-gather" small-view/center.exr -d float -o shown-small.exr --show $what
    psnr_is shown.exr shown-small.exr 20 "--show $what"
done
exits 0 "$bin/dof-gather" fine.exr -o shown.png
oiiotool --info shown.png | grep -q '80 x *48' || fail "PNG: $(oiiotool --info shown.png)"

# Colours are converted after sub-pixels are averaged, so the mean is one of linear light.
exits 0 "$bin/dof-gather" fine.exr -d float -o linear.exr --lens-radius 0
oiiotool linear.exr --ch R,G,B --colorconvert linear sRGB -d float -o expected.exr
exits 0 "$bin/dof-gather" fine.exr -d float -o srgb.exr --lens-radius 0 --output-colorspace sRGB
oiiotool srgb.exr --ch R,G,B -d float -o encoded.exr
same encoded.exr expected.exr "--output-colorspace of sub-pixels" 1e-4

# --max-memory and bands: an LDI of many samples, gathered at once (--depth-out needs all samples) and in bands.
if [ -x "$bin/sparselens-deep-scene" ]; then
    exits 0 "$bin/sparselens-deep-scene" apart 64 600 deep.exr
    how=(--lens-radius 2.25 --quality draft --supersample 2 -d float)
    for options in "" "--max-memory 300MB"; do
        exits 0 "$bin/dof-gather" deep.exr -o bands.exr "${how[@]}" $options
        exits 0 "$bin/dof-gather" deep.exr -o whole.exr "${how[@]}" --depth-out z.exr $options
        same bands.exr whole.exr "in bands, with '$options'"
    done
fi

# Each eye of a stereo file gives the same picture as that eye's own file, with a lens; the mattes of a blurred pixel
# add up to all of it.
for eye in left right; do
    oiiotool $([ $eye = left ] && echo fine || echo plain)/center.exr --attrib:type=string view $eye \
        --attrib:type=int ldi.supersample 2 -d float -o $eye.exr
done
oiiotool left.exr right.exr --siappendall -o stereo.exr
exits 0 "$bin/dof-gather" stereo.exr -d float -o eye.%V.exr --stereo-view all
for eye in left right; do
    exits 0 "$bin/dof-gather" $eye.exr -d float -o alone.exr
    same eye.$eye.exr alone.exr "the $eye eye"
done
matte=CryptoObject00
picture make ids.exr 160x96 R=0 G=1 B=0 A=1 Z=6 $matte.R=1.5 $matte.G=1 $matte.B=0 $matte.A=0 \
    fill=81x96 R=1 G=0 Z=2 $matte.R=2.5e38
exits 0 "$bin/dof-gather" ids.exr -o ids-out.exr "${lens[@]}" --supersample 2 -d float --overscan crop
total=$(awk -v a="$(picture sum ids-out.exr CryptoObject00.G)" -v b="$(picture sum ids-out.exr CryptoObject00.A)" 'BEGIN { print a + b }')
awk -v t="$total" 'BEGIN { exit !(t > 3839.99 && t < 3840.01) }' || fail "coverages of blurred mattes: $total of 3840"
