#!/bin/bash
# Denoised views with automatic overscan, whose windows begin outside the picture: Take Picture gives ldi-warp both
# colours of each view, and Blender finds a picture without layers in the file. Needs a Blender with a denoiser, which
# Debian 12's lacks and tests/blender/bpy.sh has. Pictures of 96x54; half a minute.
#   bash denoised.sh BIN_DIR
. "$(dirname "$0")/by_hand.sh"
PATH=$bin:$PATH
blender -b --python-expr 'import _cycles, sys; sys.exit(0 if getattr(_cycles, "with_openimagedenoise", True) else 1)' >said 2>&1 ||
    skip "denoised views: this Blender has no denoiser"
in_blender -P "$scene" -- CYCLES 96x54 save "$PWD/noisy.blend"
in_blender noisy.blend --python-expr "import bpy; bpy.context.scene.cycles.use_denoising = True
bpy.ops.wm.save_as_mainfile(filepath='$PWD/smooth.blend')"
in_blender noisy.blend -P "$scene" -- CYCLES 96x54 truth 512 "$PWD/truth.exr"

for kind in noisy smooth; do
    press $kind.blend $kind set views=4 set overscan_auto=True render take compose "$PWD/composed.exr"
    for view in center view_0 view_1 view_2 view_3; do
        exrheader $kind/$view.exr | grep -Eq '^dataWindow .*\(-[1-9][0-9]* -[1-9][0-9]*\)' || fail "$kind/$view.exr has no overscan"
    done
done
exrheader smooth/center.exr | grep -q 'ViewLayer.Noisy Image.R' || fail "the denoised views do not hold their noise"
for which in channels BlenderMultiChannel; do
    if exrheader smooth/picture.exr | sed -n "/^$which/,/^compression/p" | grep -E 'ViewLayer|Blender V'; then fail "the picture has layers"; fi
done
ldi-warp smooth/center.exr smooth/view_?.exr --noisy 'ViewLayer.Noisy Image' -o hand.ldi.exr 2>log || fail "$(cat log)"
gathered_by_hand hand.ldi.exr --focus-distance 4 --fstop 0.5
same smooth/picture.exr "denoised views"
oiiotool composed.exr --ch R,G,B -o a.exr smooth/picture.exr --ch R,G,B -o b.exr
oiiotool a.exr b.exr --fail 0.001 --hardfail 0.002 --diff >log 2>&1 || fail "the node group gives another picture: $(cat log)"
noisy=$(decibels noisy/picture.exr truth.exr) smooth=$(decibels smooth/picture.exr truth.exr)
echo "denoised views with overscan: $smooth dB, noisy ones $noisy dB"
better "$smooth" 30 0 "denoised views"
better "$smooth" "$noisy" 0 "denoised views beside noisy ones"

# The script does the same, and its rays are not denoised.
in_blender smooth.blend -P "$views" -- --picture --samples 4 --views 2 --finish 4 -o "$PWD/line/a.exr"
by_hand line/views "" # without --noisy
if picture same line/views/gathered.exr hand.exr >found 2>&1; then fail "the script does not give ldi-warp what the views were before"; fi
ldi-warp line/views/{center,view_0,view_1}.exr --noisy 'ViewLayer.Noisy Image' -o hand.ldi.exr 2>log || fail "$(cat log)"
gathered_by_hand hand.ldi.exr
same line/views/gathered.exr "denoised views of the script"
! exrheader line/views/rays_1.exr | grep Noisy >/dev/null || fail "rays are not denoised"

# A picture with passes has no size in Blender, and its colours another name.
in_blender noisy.blend --python-expr "import bpy; bpy.context.view_layer.aovs.add().name = 'mine'
bpy.ops.wm.save_as_mainfile(filepath='$PWD/passes.blend')"
press passes.blend passes render take compose "$PWD/composed.exr"
oiiotool composed.exr --ch R,G,B -o a.exr passes/picture.exr --ch R,G,B -o b.exr
oiiotool a.exr b.exr --fail 0.001 --hardfail 0.002 --diff >log 2>&1 || fail "the node group of a picture with passes: $(cat log)"
echo "a picture with passes: its colours in the node group"
