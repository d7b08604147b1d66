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

# One picture answers both questions of a frame, without the denoiser, and the engine keeps the scene for the renders after
# it. The lines say how far the views are, and what they cost.
cat >costs.py <<END
import sys
sys.path.insert(0, "$(dirname "$views")")
import bpy
from sparselens_blender import command, costs, exr
def render_now(scene, steps):
    for step in steps:
        cycles = scene.cycles
        print("render", step, cycles.use_denoising, cycles.samples, cycles.max_bounces, scene.render.use_persistent_data, flush=True)
        bpy.ops.render.render(write_still=True, scene=scene.name)
command.render_now = render_now
def header_of(path):  # 4 s a view, a half of whose pixels are overscan; none has the time of the last one
    time = {} if path == "x.exr" else {"RenderTime": exr.exr_text("00:04.00")}
    return time | {"displayWindow": exr.exr_box(0, 0, 20, 10), "dataWindow": exr.exr_box(-5, -5, 40, 10)}
own, costs.header_of = costs.header_of, header_of
views = ["a/center.exr"] + ["a/view_%d.exr" % number for number in range(4)]
for words in (views, None), (views, 0.5), (views, 2), (["x.exr"], 1), (views[1:], 1):
    print("cost", costs.in_words(*words), flush=True)
costs.header_of = own
END
in_blender smooth.blend -P costs.py -P "$views" -- -o cost --samples 8 --views 2
grep '^render ' said >renders || fail "no renders: $(tail -n 5 said)"
printf 'render %s\n' 'edges False 1 0 True' 'center.exr True 2 2 True' 'view_0.exr True 2 2 True' 'view_1.exr True 2 2 True' | cmp - renders ||
    fail "the renders of a frame: $(cat renders)"
grep -q '^sparselens: view_0.exr: 2 of 3 views, 66 %$' said || fail "no progress: $(grep ^sparselens said)"
grep -Eq '^sparselens: 3 views took [0-9.]+ s, as [0-9.]+ renders through the lens$' said || fail "no cost: $(grep ^sparselens said)"
{
    echo 'cost 5 views took 20.0 s, as 10.0 renders through the lens'
    echo 'cost 5 views took 20.0 s, as 10.0 renders through the lens; another focus takes 0.5 s instead of 2.0 s, so the views save time from focus 14 on'
    echo 'cost 5 views took 20.0 s, as 10.0 renders through the lens; another focus takes 2.0 s, and a render 2.0 s'
    echo 'cost '
    echo 'cost '
} >words
grep '^cost ' said | cmp words - || fail "what views cost: $(grep '^cost ' said)"
echo "one probe without the denoiser; what views cost"

# A picture with passes has no size in Blender, and its colours another name.
in_blender noisy.blend --python-expr "import bpy; bpy.context.view_layer.aovs.add().name = 'mine'
bpy.ops.wm.save_as_mainfile(filepath='$PWD/passes.blend')"
press passes.blend passes render take compose "$PWD/composed.exr"
oiiotool composed.exr --ch R,G,B -o a.exr passes/picture.exr --ch R,G,B -o b.exr
oiiotool a.exr b.exr --fail 0.001 --hardfail 0.002 --diff >log 2>&1 || fail "the node group of a picture with passes: $(cat log)"
echo "a picture with passes: its colours in the node group"
