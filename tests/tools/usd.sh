#!/bin/bash
# Layers of USD: the cameras that ldi-plan writes, from a centre view, from a camera of USD, and over frames; and
# ldi-warp with them.
. "$(dirname "$0")/check.sh"
same() { picture same "$@" >found || fail "$1 and $2 differ ($(cat found))"; }
changes() { if cmp -s "$1" "$2"; then fail "$3 changes nothing"; fi; }
# The pictures of two LDIs whose positions differ by the rounding to float in files: a sample here and there.
near() {
    "$bin/dof-gather" "$1" -o a.exr && "$bin/dof-gather" "$2" -o b.exr
    "$bin/dof-compare" a.exr b.exr | awk '$1 == "psnr_tonemapped" { print $2; exit !($2 == "inf" || $2 > 50) }' >db || fail "$1 and $2: $(cat db) dB"
}
says() { grep -Eq -e "$1" "$2" || fail "'$1' is not in $2"; }

# The views of a plan, rendered where the layer puts the cameras: --camera gives the same LDI as --view and the options
# of the lens, to the bit, for files without camera and lens.
"$bin/dof-trace" fence --size 96x54 --views 4 --spp 2 --dolly 0.3 -o views
exits 0 "$bin/ldi-plan" views/center.exr -o plan.json --views 0 --cameras shot.usda
exits 0 "$bin/ldi-plan" --camera shot.usda --cameras views.usda
mkdir bare
for view in center view_0 view_1 view_2 view_3; do picture edit views/$view.exr bare/$view.exr 'erase=.*'; done
fails_saying 2 'is unknown: give --' "$bin/ldi-plan" bare/center.exr -o x.json
exits 0 "$bin/ldi-warp" --camera views.usda bare/center.exr bare/view_{0..3}.exr -o by-usd.exr -v
says 'focal length 36 mm, film 36 mm across the picture, scene unit 1 m \(views.usda</sparselens/lens/center>\)' stderr
read -r radius focus <<<"$(python3 -c 'import json; p = json.load(open("plan.json")); print(p["lens"]["radius"], p["lens"]["focus_distance"])')"
lens=(--focal-length 36 --sensor-width 36 --lens-radius "$radius" --focus-distance "$focus")
exits 0 "$bin/ldi-warp" "${lens[@]}" bare/center.exr --view "$radius,0" bare/view_0.exr --view "0,$radius" bare/view_1.exr \
    --view "-$radius,0" bare/view_2.exr --view "0,-$radius" bare/view_3.exr -o by-options.exr
same by-usd.exr by-options.exr
exits 0 "$bin/ldi-warp" views/center.exr views/view_{0..3}.exr -o by-headers.exr
near by-usd.exr by-headers.exr

# Only lens and frustum, if no camera has the name of a rim view; --view or the files place the views.
sed 's/def Camera "view_.*"/def Camera "other"/' shot.usda >lens.usda
exits 0 "$bin/ldi-warp" --camera lens.usda bare/center.exr --view "$radius,0" bare/view_0.exr --view "0,$radius" bare/view_1.exr \
    --view "-$radius,0" bare/view_2.exr --view "0,-$radius" bare/view_3.exr -o by-lens.exr
same by-lens.exr by-options.exr
exits 0 "$bin/ldi-warp" --camera lens.usda views/center.exr views/view_{0..3}.exr -o mixed.exr
same mixed.exr by-headers.exr
cp bare/view_0.exr bare/right.exr
fails_saying 2 'right.exr: views.usda has no camera of this name' "$bin/ldi-warp" --camera views.usda bare/center.exr bare/right.exr bare/view_1.exr -o x.exr
fails_saying 2 'right.exr: .*--view' "$bin/ldi-warp" --camera lens.usda bare/center.exr bare/right.exr -o x.exr

# The plan by a camera of USD is that by the lens of the file; options override it.
exits 0 "$bin/ldi-plan" views/center.exr -o by-header.json
exits 0 "$bin/ldi-plan" bare/center.exr --camera shot.usda -o by-usd.json
python3 - <<'END' || fail "plans differ"
import json, math
def alike(a, b):
    if isinstance(a, dict): return a.keys() == b.keys() and all(alike(a[k], b[k]) for k in a if k != "center")
    if isinstance(a, list): return len(a) == len(b) and all(map(alike, a, b))
    return math.isclose(a, b, rel_tol=1e-12, abs_tol=1e-12) if isinstance(a, float) else a == b
raise SystemExit(not alike(json.load(open("by-header.json")), json.load(open("by-usd.json"))))
END
exits 0 "$bin/ldi-plan" bare/center.exr --camera shot.usda --fstop 100 -o narrow.json
changes narrow.json by-usd.json --fstop
exits 0 "$bin/ldi-plan" bare/center.exr --camera shot.usda -o x.json --cameras both.usda
says 'view_0.exr' both.usda

# A film of another shape than the picture, a shifted one, and a scene in centimetres.
cat >cm.usda <<'END'
#usda 1.0
( metersPerUnit = 0.01 upAxis = "Z" )
def Xform "rig" {
    double3 xformOp:translate.timeSamples = { 1: (0, 0, 0), 3: (200, 0, 0) }
    uniform token[] xformOpOrder = ["xformOp:translate"]
    def Camera "wide" { float focalLength = 24 float horizontalAperture = 36 float verticalAperture = 24
        float fStop = 2 float focusDistance = 250 }
    def Camera "tele" { float focalLength = 85 float horizontalAperture = 36 float verticalAperture = 24
        float fStop = 4 float focusDistance = 500 }
}
END
fails_saying 2 'several cameras: give --camera-name, one of /rig/wide, /rig/tele' "$bin/ldi-plan" --camera cm.usda --size 96x54 --cameras x.usda
fails_saying 2 'cm.usda has no render settings with a resolution: give --size' "$bin/ldi-plan" --camera cm.usda --camera-name tele --cameras x.usda
exits 0 "$bin/ldi-plan" --camera cm.usda --camera-name tele --size 96x54 --cameras tele.usda
exits 0 "$bin/ldi-plan" --camera cm.usda --camera-name /rig/wide --size 96x54 --cameras wide.usda
changes tele.usda wide.usda --camera-name
says 'upAxis = "Z"' tele.usda
says 'metersPerUnit = 0.01' tele.usda
says 'horizontalAperture = 42.66' tele.usda # 24 mm high
says 'xformOp:translate = \(1.0625, 0, 0\)' tele.usda # 85 mm / (2 x 4) = 10.6 mm
says '3: "view_3.0003.exr"' tele.usda
exits 0 "$bin/ldi-plan" --camera cm.usda --camera-name tele --size 96x96 --up-axis Y --views 2 --cameras square.usda
says 'upAxis = "Y"' square.usda
says 'horizontalAperture = 36$' square.usda
if grep -q view_2 square.usda; then fail "--views 2 gives three views"; fi
exits 0 "$bin/ldi-plan" --camera cm.usda --camera-name tele --camera-frame 2 --size 96x54 --cameras at-2.usda
says '\(100, 0, 0, 1\)' at-2.usda
exits 0 "$bin/ldi-plan" --camera cm.usda --camera-name tele --frames 2-3 --size 96x54 --cameras range.usda
says 'startTimeCode = 2' range.usda
says '3: .*\(200, 0, 0, 1\)' range.usda
exits 0 "$bin/ldi-plan" --camera cm.usda --camera-name tele --size 96x54 --fstop 1 --scene-unit 0.01 --cameras fast.usda
says 'xformOp:translate = \(4.25, 0, 0\)' fast.usda
fails_saying 2 'rig/tele> is animated: give --camera-frame' "$bin/ldi-warp" --camera cm.usda --camera-name tele bare/center.exr -o x.exr
exits 0 "$bin/ldi-warp" --camera cm.usda --camera-name tele --camera-frame 3 bare/center.exr -o at-3.exr
exits 0 "$bin/ldi-warp" --camera cm.usda --camera-name wide --camera-frame 3 bare/center.exr -o wide.exr
changes at-3.exr wide.exr --camera-name
exits 0 "$bin/ldi-warp" --camera cm.usda --camera-name tele --camera-frame 1 bare/center.exr -o at-1.exr
changes at-1.exr at-3.exr --camera-frame
exits 0 "$bin/ldi-warp" --camera cm.usda --camera-name tele --focal-length 24 --camera-frame 1 bare/center.exr -v -o x.exr

# One layer for all frames of a range, from centre views that record their cameras. --skip-existing does not lose frames.
for frame in 1 2 3; do
    "$bin/dof-trace" fence --size 48x27 --views 4 --spp 1 --dolly 0.$frame -o $frame
    for view in center view_0 view_1 view_2 view_3; do cp $frame/$view.exr $view.000$frame.exr; done
done
exits 0 "$bin/ldi-plan" center.####.exr --frames 1-3 -o plan.####.json --cameras keyed.usda
exits 0 "$bin/ldi-plan" center.####.exr --frames 1-3 --fstop 1:0.3,3:0.6 -o plan.####.json --cameras pull.usda
says 'xformOp:translate.timeSamples' pull.usda
says '3: \(0.03, 0, 0\)' pull.usda
says '2: "center.0002.exr"' keyed.usda
cp keyed.usda first.usda
exits 0 "$bin/ldi-plan" center.####.exr --frames 1-3 -o plan.####.json --cameras keyed.usda --skip-existing
cmp keyed.usda first.usda || fail "--skip-existing loses frames"
exits 0 "$bin/ldi-plan" --camera keyed.usda --camera-name center --cameras ring.usda
exits 0 "$bin/ldi-warp" --camera ring.usda center.####.exr view_{0..3}.####.exr --frames 1-3 -o usd.####.exr
exits 0 "$bin/ldi-warp" center.####.exr view_{0..3}.####.exr --frames 1-3 -o own.####.exr
for frame in 1 2 3; do near usd.000$frame.exr own.000$frame.exr; done

# What cannot be: one line.
fails_saying 2 'give a centre view, or --camera SHOT.usda and --cameras VIEWS.usda' "$bin/ldi-plan" --camera shot.usda
fails_saying 2 'give a centre view' "$bin/ldi-plan" --camera shot.usda --cameras x.json
fails_saying 2 '--output: a plan needs a centre view' "$bin/ldi-plan" --camera shot.usda --cameras x.usda -o x.json
fails_saying 2 '--output is required' "$bin/ldi-plan" views/center.exr
fails_saying 2 'would overwrite the input shot.usda' "$bin/ldi-plan" --camera shot.usda --cameras shot.usda
fails_saying 2 '--size' "$bin/ldi-plan" --camera shot.usda --cameras x.usda --size 96
fails_saying 2 '--up-axis' "$bin/ldi-plan" --camera shot.usda --cameras x.usda --up-axis X
fails_saying 2 '--camera-name' "$bin/ldi-plan" views/center.exr -o x.json --camera-name a
fails_saying 1 'missing.usda' "$bin/ldi-plan" --camera missing.usda --cameras x.usda
fails_saying 1 'center.exr: is not textual USD' "$bin/ldi-plan" --camera views/center.exr --cameras x.usda
fails_saying 1 'bare/center.exr: does not say where its camera stands \(worldToCamera\): give its --camera' \
    "$bin/ldi-plan" bare/center.exr "${lens[@]}" -o x.json --cameras x.usda
[ ! -e x.usda ] || fail "a failure wrote x.usda"
