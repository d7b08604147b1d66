#!/bin/bash
# Blender's own renders of a border, with and without Crop, of a rectangle for which dof-finish --ask asks.
#   bash border.sh BIN_DIR
. "$(dirname "$0")/common.sh"
in_blender -P "$scene" -- CYCLES 96x54 save "$PWD/small.blend"
each_variant small keys,blades
in_blender keys,blades.blend -P "$views" -- "${plain[@]}" -o rays --frame 3 --samples 4 --finish 16
"$bin/ldi-warp" rays/center.exr rays/view_?.exr -o - | "$bin/dof-gather" - -o gathered.exr
finished() { # OUT RENDER...
    "$bin/dof-finish" gathered.exr rays/rays_1.exr rays/rays_2.exr "${@:2}" -o "$1" 2>said || fail "$*: $(cat said)"
    [ ! -s said ] || fail "$*: $(cat said)"
}
finished draft.exr --ask mask.exr --rays 48 >asked
# The largest part that does not begin in the corner, where a crop would lie anyway.
read -r x y width height < <(awk -F '[, ]' '$1 + $2 > 0 { print $3 * $4, $1, $2, $3, $4 }' asked | sort -nr | head -n 1 | cut -d ' ' -f 2-)
in_blender keys,blades.blend -P "$variants" -- border 128 3 "$x,$y,$width,$height" "$PWD"
exrheader crop_1.0003.exr | grep -q "^dataWindow (type box2i): (0 0) - ($((width - 1)) $((height - 1)))" || fail "Crop: $(exrheader crop_1.0003.exr | grep Window)"
finished black.exr black_{1,2}.0003.exr --samples 8,8,128,128
finished crop.exr "crop_1.0003.exr@$x,$y" "crop_2.0003.exr@$x,$y" --samples 8,8,128,128
picture same black.exr crop.exr >said 2>&1 || fail "Crop is not the picture of the border: $(cat said)"
in_blender keys,blades.blend -P "$variants" -- render 512 3 3 "$PWD/truth.####.exr"
within() { oiiotool "$1" --ch R,G,B,A --cut "${width}x$height+$x+$y" --origin +0+0 --fullsize "${width}x$height+0+0" -o "$2"; }
for name in draft black; do within $name.exr $name.part.exr; done
within truth.0003.exr truth.part.exr
better "$(decibels black.part.exr truth.part.exr)" "$(decibels draft.part.exr truth.part.exr)" 1 "renders of the border $x,$y,$width,$height"
echo "renders of a border, with and without Crop: the same, better picture"
