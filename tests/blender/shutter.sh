#!/bin/bash
# --shutter: the moments of a shutter in 96x54 pixels, and their picture beside Cycles' own motion blur and depth of field.
# Two minutes.
#   bash shutter.sh BIN_DIR
. "$(dirname "$0")/common.sh"
in_blender -P "$scene" -- CYCLES 96x54 save "$PWD/small.blend"

# The times of the moments: for a box in the middles of equal parts; for a triangle each stands for an equal area, so
# the first of two is where the area is 1/4: at sqrt(1/8).
in_blender --python-expr "
import sys, math
sys.path.insert(0, '$(dirname "$views")')
from sparselens_blender.shutter import times_of
assert times_of([1] * 257, 4) == [0.125, 0.375, 0.625, 0.875], times_of([1] * 257, 4)
triangle = [1 - abs(i / 500 - 1) for i in range(1001)]
first, last = times_of(triangle, 2)
assert abs(first - math.sqrt(1 / 8)) < 1e-3 and abs(last - 1 + first) < 1e-9, (first, last)
"

# Names, headers, samples, and the scene as it was.
variant small pan
cat >render.py <<'END'
import sys
import bpy
sys.path.insert(0, sys.argv[-1])
from sparselens_blender import panel
panel.register()
scene, settings = bpy.context.scene, bpy.context.scene.sparselens
scene.frame_set(3, subframe=0.25)
scene.render.motion_blur_shutter_curve.initialize()
def state():
    return (scene.frame_current, scene.frame_subframe, scene.render.use_motion_blur, scene.cycles.seed,
            scene.cycles.samples, tuple(scene.camera.matrix_world.col[0]))
before = state()
settings.folder, settings.shutter, settings.overscan_auto, settings.views = "//panel/", 2, False, 2
bpy.ops.sparselens.render_views()
assert state() == before, (state(), before)
END
in_blender pan.blend -P render.py -- "$(dirname "$views")"
[ "$(cd panel && echo *)" = "center_0.exr center_1.exr view_0_0.exr view_0_1.exr view_1_0.exr view_1_1.exr" ] || fail "names: $(ls panel)"
exrheader panel/view_0_1.exr >header
for line in 'sparselens:frame (type int): 3' 'sparselens:moment (type int): 1' 'sparselens:moments (type int): 2' \
    'sparselens:time (type float): 3.125'; do
    grep -Fq "$line" header || fail "no '$line' in $(grep sparselens: header)"
done
unlike panel/center_0.exr panel/center_1.exr 35

# Views of a moment are those of a camera that stands still there: the camera turns by 0.06 a frame.
in_blender pan.blend --python-expr "
import bpy, math
camera = bpy.context.scene.camera
camera.animation_data_clear()
camera.rotation_euler = math.pi / 2, 0, 0.15 - 0.06 * 2.125
bpy.context.scene.render.use_motion_blur = False
bpy.context.scene.cycles.seed += 9973
bpy.ops.wm.save_as_mainfile(filepath='$PWD/turned.blend')"
in_blender turned.blend -P "$views" -- -o turned --views 1 --samples 32 --overscan 0
alike panel/center_1.exr turned/center.exr 50

# Fewer moments leave none of an earlier run.
in_blender pan.blend -P "$views" -- -o names --shutter 4 --frames 2,3 --samples 4 --views 1 --overscan 0
[ "$(ls names | wc -l)" -eq 16 ] && [ -e names/view_0.0003_3.exr ] || fail "names: $(ls names)"
in_blender pan.blend -P "$views" -- -o names --shutter 2 --frames 2,3 --samples 4 --views 1 --overscan 0
[ "$(ls names | wc -l)" -eq 8 ] || fail "moments of an earlier run: $(ls names)"

# --supersample auto: the first moment decides for all; a moment has its part of the samples, at least one for a sub-pixel.
in_blender pan.blend --python-expr "import bpy; bpy.context.scene.camera.data.dof.aperture_fstop = 0.5
bpy.ops.wm.save_as_mainfile(filepath='$PWD/wide.blend')"
in_blender wide.blend -P "$views" -- -o auto --shutter 2 --frame 3 --samples 8 --views 0 --overscan 0
[ "$(grep -c 'frame 2.875: .* supersample 2$' said)/$(grep -c 'at edges of depth' said)" = 1/1 ] || fail "--supersample auto: $(cat said)"
for moment in 0 1; do
    exrheader auto/center_$moment.exr | grep -F 'ldi.supersample (type int): 2' >/dev/null || fail "--supersample auto: moment $moment"
done
in_blender wide.blend -P "$views" -- -o auto --shutter 2 --frame 3 --samples 7 --views 0 --overscan 0
! exrheader auto/center_0.exr | grep -F 'ldi.supersample' >/dev/null || fail "--supersample auto: 7 samples for 8 sub-pixels"

# Pictures: within a decibel of Cycles' own motion blur as the still is of Cycles' still, and nearer to it than the still.
variant small spin
for kind in pan spin; do
    in_blender $kind.blend -P "$variants" -- render 256 3 3 "$PWD/$kind.####.exr"
    in_blender $kind.blend --python-expr "import bpy; bpy.context.scene.render.use_motion_blur = False
bpy.ops.wm.save_as_mainfile(filepath='$PWD/sharp.blend')"
    in_blender sharp.blend -P "$variants" -- render 256 3 3 "$PWD/sharp.####.exr"
    in_blender sharp.blend -P "$views" -- -o $kind.still.exr --picture --frame 3 --samples 64 --tools "$bin" --views-folder still
    in_blender $kind.blend -P "$views" -- -o $kind.exr --picture --frame 3 --samples 64 --tools "$bin" --shutter 4 --views-folder moments
    own=$(decibels $kind.still.exr sharp.0003.exr) still=$(decibels $kind.still.exr $kind.0003.exr)
    moments=$(decibels $kind.exr $kind.0003.exr)
    echo "$kind: four moments $moments dB; still $own dB, beside the motion $still dB"
    better "$moments" "$still" 3 "$kind: moments beside the still"
    better "$moments" "$own" -1.5 "$kind: moments as the still"
    rm -r still moments
done

# A rolling shutter whose curve rises, beside Cycles' own: the moments have even times, and dof-gather gets the curve.
in_blender pan.blend --python-expr "
import bpy
scene = bpy.context.scene
scene.cycles.rolling_shutter_type, scene.cycles.rolling_shutter_duration = 'TOP', 0.25
curve = scene.render.motion_blur_shutter_curve
curve.initialize()
curve.curves[0].points[0].location = 0, 0
curve.update()
bpy.ops.wm.save_as_mainfile(filepath='$PWD/rolling.blend')"
in_blender rolling.blend -P "$variants" -- render 512 3 3 "$PWD/rolling.####.exr"
in_blender rolling.blend -P "$views" -- -o rolling.exr --picture --frame 3 --samples 32 --tools "$bin" --shutter 8 --views-folder moments
exrheader moments/center_0.exr | grep -Fq 'sparselens:time (type float): 2.78125' || fail "the moments of a rolling shutter are not even"
[ "$(head -n 1 moments/shutter_curve.txt)/$(wc -l <moments/shutter_curve.txt)" = "0.0 0.0/257" ] || fail "the curve: $(cat moments/shutter_curve.txt)"
rolling=$(decibels rolling.exr rolling.0003.exr) together=$(decibels pan.exr rolling.0003.exr)
echo "rolling shutter: eight moments $rolling dB; all rows together $together dB"
better "$rolling" "$together" 3 "rolling shutter"
in_blender rolling.blend -P "$views" -- -o rolling --shutter 2 --frame 3 --samples 2 --views 0 --overscan 0
grep -q 'warning: the shutter rolls: give dof-gather --rolling-shutter 0.25 --shutter-curve' said || fail "views of a rolling shutter: $(cat said)"

# What is refused.
refused() { # PATTERN OPTION...
    local pattern=$1
    shift
    if blender --python-exit-code 1 -b pan.blend -P "$views" -- -o refused "$@" >said 2>&1; then fail "not refused: $*"; fi
    grep -q -e "$pattern" said || fail "$*: $(tail -n 3 said)"
}
refused '--shutter: must be from 1 to 64' --shutter 65
refused '--plan: shows one moment' --shutter 2 --plan plan.json
refused '--finish: shows one moment' --shutter 2 --finish 8
refused '--shutter 4: 3 samples a pixel are too few for 4' --shutter 4 --samples 3
