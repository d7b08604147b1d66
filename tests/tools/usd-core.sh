#!/bin/bash
# Stages of USD, read and written by USD's own library (usd-core, PyPI): the cameras that ldi-plan writes, from a centre
# view, from a camera of USD, and over frames; ldi-warp with them; and that other attributes of cameras survive.
. "$(dirname "$0")/check.sh"
usd_python
same() { picture same "$@" >found || fail "$1 and $2 differ ($(cat found))"; }
changes() { if cmp -s "$1" "$2"; then fail "$3 changes nothing"; fi; }
# The pictures of two LDIs whose positions differ by the rounding to float in files: a sample here and there.
near() {
    "$bin/dof-gather" "$1" -o a.exr && "$bin/dof-gather" "$2" -o b.exr
    "$bin/dof-compare" a.exr b.exr | awk '$1 == "psnr_tonemapped" { print $2; exit !($2 == "inf" || $2 > 50) }' >db || fail "$1 and $2: $(cat db) dB"
}
says() { grep -Eq -e "$1" "$2" || fail "'$1' is not in $2"; }

"$SPARSELENS_USD_PYTHON" "$source_dir/tests/tools/usd_cameras_test.py" "$bin" >said 2>&1 || fail "$(tail -n 30 said)"

# The views of a plan, rendered where the layer puts the cameras: --camera gives the same LDI as --view and the options
# of the lens, to the bit, for files without camera and lens.
"$bin/dof-trace" fence --size 96x54 --views 4 --spp 2 --dolly 0.3 -o views
exits 0 "$bin/ldi-plan" views/center.exr -o plan.json --views 0 --cameras shot.usda
exits 0 "$bin/ldi-plan" --camera shot.usda --cameras views.usda
mkdir bare
for view in center view_0 view_1 view_2 view_3; do picture edit views/$view.exr bare/$view.exr 'erase=.*'; done
exits 0 "$bin/ldi-warp" --camera views.usda bare/center.exr bare/view_{0..3}.exr -o by-usd.exr -v
says 'focal length 36 mm, film 36 mm across the picture, scene unit 1 m \(views.usda</sparselens/lens/center>\)' stderr
read -r radius focus <<<"$(python3 -c 'import json; p = json.load(open("plan.json")); print(p["lens"]["radius"], p["lens"]["focus_distance"])')"
lens=(--focal-length 36 --sensor-width 36 --lens-radius "$radius" --focus-distance "$focus")
placed=(--view "$radius,0" bare/view_0.exr --view "0,$radius" bare/view_1.exr --view "-$radius,0" bare/view_2.exr --view "0,-$radius" bare/view_3.exr)
exits 0 "$bin/ldi-warp" "${lens[@]}" bare/center.exr "${placed[@]}" -o by-options.exr
same by-usd.exr by-options.exr
sed 's/def Camera "view_.*"/def Camera "other"/' shot.usda >lens.usda # no camera has the name of a rim view
exits 0 "$bin/ldi-warp" --camera lens.usda bare/center.exr "${placed[@]}" -o by-lens.exr
same by-lens.exr by-options.exr
exits 0 "$bin/ldi-warp" views/center.exr views/view_{0..3}.exr -o by-headers.exr
near by-usd.exr by-headers.exr
exits 0 "$bin/ldi-warp" --camera lens.usda views/center.exr views/view_{0..3}.exr -o mixed.exr
same mixed.exr by-headers.exr

# The plan and the cameras of a centre view whose camera USD states.
exits 0 "$bin/ldi-plan" bare/center.exr --camera shot.usda -o x.json --cameras both.usda
says 'view_0.exr' both.usda

# A film of another shape than the picture, a shifted one, and a scene in centimetres.
cat >cm.usda <<'END'
#usda 1.0
(
    metersPerUnit = 0.01
    upAxis = "Z"
)
def Xform "rig" {
    double3 xformOp:translate.timeSamples = { 1: (0, 0, 0), 3: (200, 0, 0) }
    uniform token[] xformOpOrder = ["xformOp:translate"]
    def Camera "wide" {
        float focalLength = 24
        float horizontalAperture = 36
        float verticalAperture = 24
        float fStop = 2
        float focusDistance = 250
    }
    def Camera "tele" {
        float focalLength = 85
        float horizontalAperture = 36
        float verticalAperture = 24
        float fStop = 4
        float focusDistance = 500
    }
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
# As JSON, for machines without USD's library.
"$SPARSELENS_USD_PYTHON" "$source_dir/share/python/usd_cameras.py" read cm.usda >cm.json
SPARSELENS_USD_PYTHON=false exits 0 "$bin/ldi-warp" --camera cm.json --camera-name tele --camera-frame 1 bare/center.exr -o by-json.exr
same by-json.exr at-1.exr

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
exits 0 "$bin/ldi-plan" --camera keyed.usda --camera-name center --cameras ring.usdc
exits 0 "$bin/ldi-warp" --camera ring.usdc center.####.exr view_{0..3}.####.exr --frames 1-3 -o usd.####.exr
exits 0 "$bin/ldi-warp" center.####.exr view_{0..3}.####.exr --frames 1-3 -o own.####.exr
for frame in 1 2 3; do near usd.000$frame.exr own.000$frame.exr; done

# The examples of --help.
mkdir examples
cp bare/*.exr examples
cp shot.usda examples/shot.usd
for tool in ldi-plan ldi-warp; do
    "$bin/$tool" --help | sed -n '/^Examples:/,$p' | sed -n 's/^      //p' | grep '\.usd' >example || fail "$tool has no example of USD"
    (cd examples && PATH=$bin:$PATH bash -e ../example) || fail "$(cat example)"
done

# What cannot be: one line.
fails_saying 2 'give a centre view, or --camera SHOT.usd and --cameras VIEWS.usd' "$bin/ldi-plan" --camera shot.usda
fails_saying 1 'missing.usda: cannot be read as USD' "$bin/ldi-plan" --camera missing.usda --cameras x.usda
fails_saying 1 'views/center.exr: cannot be read as USD: Cannot determine file format' "$bin/ldi-plan" --camera views/center.exr --cameras x.usda
mkdir taken.usda
fails_saying 1 'taken.usda: cannot write: Is a directory' "$bin/ldi-plan" --camera shot.usda --cameras taken.usda
[ ! -e x.usda ] || fail "a failure wrote x.usda"

# Layers are written as all outputs are: into folders that are made, with the mode of the file that they replace, and not
# over a read-only one. Root may replace any file: another user tries.
exits 0 "$bin/ldi-plan" --camera shot.usda --cameras made/x.usda
cmp made/x.usda views.usda || fail "a new folder changes the layer"
chmod 640 made/x.usda
exits 0 "$bin/ldi-plan" --camera shot.usda --cameras made/x.usda
[ "$(stat -c %a made/x.usda)" = 640 ] || fail "a replaced layer loses its mode"
chmod 444 made/x.usda && chmod 755 "$scratch" && chmod 777 made
other=()
[ "$(id -u)" -ne 0 ] || other=(setpriv --reuid=54321 --regid=54321 --clear-groups)
if "${other[@]}" test -x "$bin/ldi-plan" -a -x "$SPARSELENS_USD_PYTHON"; then
    fails_saying 1 'made/x.usda: cannot replace: Permission denied' "${other[@]}" "$bin/ldi-plan" --camera shot.usda --cameras made/x.usda
else
    echo "skipped: the read-only layer: the tools cannot be run by another user"
fi
[ -z "$(ls -A . made | grep '^\.[a-z0-9]')" ] || fail "left behind: $(ls -A . made)"
