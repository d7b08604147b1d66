#!/bin/bash
# --recolor: deep samples get the colours of a flat picture; flattened they equal that picture; and pairs that do not
# fit are refused or give a warning.
. "$(dirname "$0")/check.sh"
command -v oiiotool >/dev/null || skip "needs oiiotool (openimageio-tools)"
pinhole=(--focal-length 50 --sensor-width 36 --focus-distance 6 --lens-radius 0)
lens=("${pinhole[@]:0:7}" 0.1)
same() { picture same "$@" >found 2>&1 || fail "$1 and $2 differ ($(cat found))"; }
differ() { picture differ "$@" >found 2>&1 || fail "$1 and $2 are the same"; }
silent() { [ ! -s stderr ] || fail "$1: $(cat stderr)"; }
warns() { [ "$(grep -c -e "warning: .*$1" stderr)" -eq 1 ] && [ "$(wc -l <stderr)" -eq 1 ] || fail "no single warning '$1': $(cat stderr)"; }

# recoloured DEEP FLAT: DEEP's alpha, depth and back depth alone, with the colours of the flat picture, equal the flat
# picture when flattened by oiiotool, and by dof-gather at CoC 0.
recoloured() {
    picture edit "$2" flat.exr channels=R,G,B,A float=
    exits 0 "$bin/ldi-cluster" "$1" --recolor flat.exr --tolerance 0 "${lens[@]}" -o out.exr
    silent "$1"
    oiiotool out.exr --flatten --ch R,G,B,A -o out-flat.exr
    same out-flat.exr flat.exr R,G,B 1e-3
    same out-flat.exr flat.exr A 1e-3
    exits 0 "$bin/dof-gather" "$1" --recolor flat.exr "${pinhole[@]}" -o sharp.exr
    same sharp.exr flat.exr R,G,B,A 1e-3
}
# blurred DEEP: recolouring and blurring in one step gives the same as in two.
blurred() {
    exits 0 "$bin/dof-gather" "$1" --recolor flat.exr "${lens[@]}" -o one-step.exr
    exits 0 "$bin/dof-gather" out.exr "${lens[@]}" -o two-steps.exr
    same one-step.exr two-steps.exr R,G,B,A 3e-3
    differ one-step.exr flat.exr R,G,B,A 1e-2
}
for scene in fence mist element; do
    for deep in visible peel:3; do
        exits 0 "$bin/dof-trace" $scene --size 64x36 --spp 8 --views 0 --deep $deep -o $scene
        oiiotool $scene/deep_*.exr --flatten --ch R,G,B,A -o $scene.flat.exr
        oiiotool $scene/deep_*.exr --ch "$([ $scene-$deep = mist-visible ] && echo A,Z,ZBack || echo A,Z)" -o $scene.deep.exr
        recoloured $scene.deep.exr $scene.flat.exr
        blurred $scene.deep.exr
        rm $scene/deep_*.exr
    done
done
for file in Balls Leaves Trunks; do # deep files by others, if they are there
    other=$source_dir/../shared/deep/$file.exr
    [ -e "$other" ] || continue
    oiiotool "$other" --flatten --ch R,G,B,A -o other.exr
    oiiotool "$other" --ch A,Z -o other.deep.exr
    recoloured other.deep.exr other.exr
done

# A small pair: a card of half coverage at 2 before one at 4 that covers the right half, and nothing on the left.
deepened() { oiiotool "$1" --ch "$2" --deepen -o "$3"; }
picture make near.exr 32x18 R=0 G=0 B=0 A=0.5 id=3 Z=2
picture make far.exr 32x18 R=0 G=0 B=0 A=0 id=4 Z=inf fill=16x18+16+0 A=0.5 Z=4
deepened near.exr A,Z near.deep.exr
deepened far.exr A,Z far.deep.exr
exits 0 "$bin/ldi-cluster" near.deep.exr far.deep.exr --tolerance 0 --layers 9 -o deep.exr
picture make plain.exr 32x18 R=0.25 G=noise:1 B=noise:2 A=0.5 diffuse.R=0.125 diffuse.G=noise:3 diffuse.B=0.5 N.X=0.5 Z=inf \
    fill=16x18+16+0 A=0.75 R=0.5
passes=R,G,B,diffuse.R,diffuse.G,diffuse.B
exits 0 "$bin/ldi-cluster" deep.exr --recolor plain.exr --tolerance 0 "${lens[@]}" -o out.exr
silent "a plain pair"
oiiotool out.exr --flatten -o flat.exr
same flat.exr plain.exr $passes,A 1e-3
if picture edit flat.exr x.exr channels=N.X 2>/dev/null; then fail "data of the flat picture are carried"; fi
rm -f x.exr
[ "$(picture samples out.exr)" = "$(picture samples deep.exr)" ] || fail "other samples: $(picture samples out.exr)"
[ "$(oiiotool --dumpdata out.exr | grep -c 'Z=2')" -eq 576 ] || fail "other depths"
# Several deep files are recoloured as one.
exits 0 "$bin/ldi-cluster" near.deep.exr far.deep.exr --recolor plain.exr --tolerance 0 "${lens[@]}" -o merged.exr
same merged.exr out.exr
# The samples' own colours do not matter.
oiiotool plain.exr --ch R,G,B,A,Z=2 --deepen -o coloured.exr
exits 0 "$bin/ldi-cluster" coloured.exr --recolor plain.exr --tolerance 0 "${lens[@]}" -o own.exr
oiiotool own.exr --flatten -o flat.exr
same flat.exr plain.exr $passes,A 1e-3

# Nuke's names are kept, frames are matched, and an output does not overwrite the beauty.
picture edit plain.exr nuke.0001.exr channels=red=R,green=G,blue=B,alpha=A
exits 0 "$bin/dof-gather" deep.exr --recolor nuke.####.exr --frames 1 "${lens[@]}" -o nuke-out.####.exr
exits 0 "$bin/dof-gather" deep.exr --recolor plain.exr "${lens[@]}" -o by-name.exr
picture edit nuke-out.0001.exr back.exr channels=R=red,G=green,B=blue
same back.exr by-name.exr R,G,B
fails_saying 2 'would overwrite the input plain.exr' "$bin/ldi-cluster" deep.exr --recolor plain.exr "${lens[@]}" -o plain.exr

# Colours of the beauty are made linear from its stated space, or from the given one; the result states it as well.
picture edit plain.exr stated.exr set=oiio:ColorSpace:sRGB
exits 0 "$bin/dof-gather" deep.exr --recolor plain.exr --colorspace sRGB "${pinhole[@]}" -o given.exr
exits 0 "$bin/dof-gather" plain.exr --depth-file near.exr --colorspace sRGB "${pinhole[@]}" -o expected.exr
same given.exr expected.exr R,G,B 2e-3
differ given.exr plain.exr R 1e-2
picture edit plain.exr acescg.exr set=colorInteropID:lin_ap1_scene
exits 0 "$bin/ldi-cluster" deep.exr --recolor acescg.exr "${lens[@]}" -o out.exr
oiiotool --info -v out.exr >said
grep -q 'lin_ap1_scene' said || fail "the space of the beauty is not stated: $(cat said)"
exits 0 "$bin/ldi-cluster" deep.exr --recolor stated.exr "${lens[@]}" --tolerance 0 -o out.exr
exits 0 "$bin/dof-gather" out.exr "${pinhole[@]}" -o stated-out.exr
same stated-out.exr expected.exr R,G,B 2e-3
sed 's/srgb_texture/another_name/' "$source_dir/share/ocio/config.ocio" >config.ocio
exits 0 "$bin/ldi-cluster" deep.exr --recolor plain.exr --colorspace another_name --colorconfig config.ocio "${lens[@]}" --tolerance 0 -o named.exr
same named.exr out.exr
for option in --colorspace --colorconfig; do
    fails_saying 2 "$option.*--recolor" "$bin/ldi-cluster" deep.exr $option sRGB "${lens[@]}" -o x.exr
done

# Pixels that do not fit give a warning with their number; the light stays as in the flat picture.
picture edit plain.exr wider.exr fill=4x4+0+0 A=1
exits 0 "$bin/ldi-cluster" deep.exr --recolor wider.exr "${lens[@]}" -o out.exr
warns 'wider.exr: its coverage differs from that of deep.exr in 16 of 576 pixels'
oiiotool out.exr --flatten -o flat.exr
same flat.exr wider.exr $passes,A 1e-3
picture edit plain.exr cropped.exr crop=30x18+2+0
exits 0 "$bin/ldi-cluster" deep.exr --recolor cropped.exr "${lens[@]}" -o out.exr
warns 'cropped.exr: has no colours for 36 pixels of deep.exr'
picture edit plain.exr nans.exr fill=1x1+3+3 R=nan
exits 0 "$bin/ldi-cluster" deep.exr --recolor nans.exr "${lens[@]}" -o out.exr
warns 'nans.exr: 1 colour that is not finite'
oiiotool out.exr --flatten -o flat.exr
same flat.exr plain.exr R,A 1e-3
# A sky that the deep picture lacks is placed at infinity; light without coverage stays without.
picture make sky.exr 32x18 R=1 G=1 B=1 A=0
exits 0 "$bin/ldi-cluster" far.deep.exr --recolor sky.exr "${lens[@]}" -o out.exr
warns 'differs from that of far.deep.exr in 288 of 576'
oiiotool out.exr --flatten -o flat.exr
same flat.exr sky.exr R,G,B 1e-3

# Damaged or mismatched pairs: one line that names the file, and no output.
picture edit plain.exr frame.exr frame=64x36
picture edit plain.exr aspect.exr set=pixelAspectRatio:2
picture make elsewhere.exr 32x18+40+0 R=1 G=1 B=1 A=1
picture edit elsewhere.exr elsewhere.exr frame=32x18
picture edit plain.exr colourless.exr channels=A,Z
head -c 1000 plain.exr >cut.exr
head -c 600 deep.exr >cut-deep.exr
echo "no picture" >text.exr
oiiotool plain.exr --ch R,G,B -o plain.png
picture edit near.exr behind.exr Z=-1
deepened behind.exr A,Z behind.deep.exr
refuses() { # PATTERN DEEP FLAT
    for tool in "$bin/ldi-cluster" "$bin/dof-gather"; do
        fails_saying 1 "$1" "$tool" "$2" --recolor "$3" "${lens[@]}" -o x.exr
        [ ! -e x.exr ] || fail "$tool wrote x.exr of $2 and $3"
    done
}
refuses 'missing.exr: cannot open' deep.exr missing.exr
refuses 'text.exr' deep.exr text.exr
refuses 'cut.exr' deep.exr cut.exr
refuses 'cut-deep.exr' cut-deep.exr plain.exr
refuses 'plain.png' deep.exr plain.png
refuses 'deep.exr.*deep' near.deep.exr deep.exr
refuses 'frame.exr: its display window differs from that of deep.exr.*--recolor' deep.exr frame.exr
refuses 'aspect.exr: its pixel aspect ratio is 2, that of deep.exr is 1' deep.exr aspect.exr
refuses 'elsewhere.exr: its data window has no pixel in common with that of deep.exr' deep.exr elsewhere.exr
refuses 'colourless.exr: has no colours.*--recolor' deep.exr colourless.exr
refuses 'behind.deep.exr: depth' behind.deep.exr plain.exr
refuses 'near.deep.exr' missing/near.deep.exr plain.exr
