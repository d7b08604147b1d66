#!/bin/bash
# Cameras as JSON, in the form of share/python/usd_cameras.py, for ldi-plan and ldi-warp; and what both say of USD where no
# Python has USD's library. usd-core.sh has that library.
. "$(dirname "$0")/check.sh"
changes() { if cmp -s "$1" "$2"; then fail "$3 changes nothing"; fi; }
# The pictures of two LDIs whose positions differ by the rounding to float in files: a sample here and there.
near() {
    "$bin/dof-gather" "$1" -o a.exr && "$bin/dof-gather" "$2" -o b.exr
    "$bin/dof-compare" a.exr b.exr | awk '$1 == "psnr_tonemapped" { print $2; exit !($2 == "inf" || $2 > 50) }' >db || fail "$1 and $2: $(cat db) dB"
}
says() { grep -Eq -e "$1" "$2" || fail "'$1' is not in $2"; }

# The cameras of a plan as JSON: --camera gives the same LDI as --view and the options of the lens, for files without
# camera and lens.
"$bin/dof-trace" fence --size 96x54 --views 4 --spp 2 --dolly 0.3 -o views
exits 0 "$bin/ldi-plan" views/center.exr -o plan.json --cameras planned.json
cat >as_usd.py <<'END'
import json
plan, center = json.load(open("plan.json")), json.load(open("planned.json"))["cameras"][0]
radius, focus = plan["lens"]["radius"], plan["lens"]["focus_distance"]
def frame(matrix, time=0, stops=1):
    return {"time": time, "to_world": [value for row in matrix for value in row], "focalLength": 0.36, "horizontalAperture": 0.36,
            "verticalAperture": 0.2025, "fStop": stops * 0.036 / (2 * radius), "focusDistance": focus}
def write(name, cameras):
    cameras = [{"path": f"/rig/{name}", "frames": frames} for name, frames in cameras]
    stage = {"metersPerUnit": 1, "upAxis": "Y", "timeCodesPerSecond": 24, "settings": None, "cameras": cameras}
    json.dump(stage, open(name, "w"))
def moved(x, y):
    m = [[a, b, -c, d] for a, b, c, d in center["camera_to_world"]]  # the traced world is left-handed, which USD has not
    return m[:3] + [[m[3][i] + x * m[0][i] + y * m[1][i] for i in range(3)] + [1]]
write("views.json", [(name, [frame(moved(x, y))]) for name, x, y in (
    ("center", 0, 0), ("view_0", radius, 0), ("view_1", 0, radius), ("view_2", -radius, 0), ("view_3", 0, -radius))])
write("lens.json", [("center", [frame(moved(0, 0))]), ("other", [frame(moved(radius, 0))])])
both = [frame(moved(0, 0), 1, 1), frame(moved(0, 0), 2, 2)]
write("animated.json", [("left", both), ("shot", both)])
print(radius, focus)
END
read -r radius focus <<<"$(python3 as_usd.py)"
mkdir bare
for view in center view_0 view_1 view_2 view_3; do picture edit views/$view.exr bare/$view.exr 'erase=.*'; done
fails_saying 2 'is unknown: give --' "$bin/ldi-plan" bare/center.exr -o x.json
exits 0 "$bin/ldi-warp" --camera views.json bare/center.exr bare/view_{0..3}.exr -o by-camera.exr -v
says 'focal length 36 mm, film 36 mm across the picture, scene unit 1 m \(views.json</rig/center>\)' stderr
lens=(--focal-length 36 --sensor-width 36 --lens-radius "$radius" --focus-distance "$focus")
placed=(--view "$radius,0" bare/view_0.exr --view "0,$radius" bare/view_1.exr --view "-$radius,0" bare/view_2.exr --view "0,-$radius" bare/view_3.exr)
exits 0 "$bin/ldi-warp" "${lens[@]}" bare/center.exr "${placed[@]}" -o by-options.exr
near by-camera.exr by-options.exr
exits 0 "$bin/ldi-warp" views/center.exr views/view_{0..3}.exr -o by-headers.exr
near by-camera.exr by-headers.exr
"$bin/ldi-warp" --camera - bare/center.exr bare/view_{0..3}.exr -o piped.exr <views.json || fail "JSON from standard input"
near piped.exr by-camera.exr

# Only lens and frustum, if no camera has the name of a rim view; --view or the files place the views.
exits 0 "$bin/ldi-warp" --camera lens.json bare/center.exr "${placed[@]}" -o by-lens.exr
near by-lens.exr by-options.exr
exits 0 "$bin/ldi-warp" --camera lens.json views/center.exr views/view_{0..3}.exr -o mixed.exr
near mixed.exr by-headers.exr
cp bare/view_0.exr bare/right.exr
fails_saying 2 'right.exr: views.json has no camera of this name' "$bin/ldi-warp" --camera views.json bare/center.exr bare/right.exr bare/view_1.exr -o x.exr
fails_saying 2 'right.exr: .*--view' "$bin/ldi-warp" --camera lens.json bare/center.exr bare/right.exr -o x.exr

# The plan by a stated camera is that by the lens of the file; options override it.
exits 0 "$bin/ldi-plan" views/center.exr -o by-header.json
exits 0 "$bin/ldi-plan" bare/center.exr --camera lens.json -o by-camera.json
python3 - <<'END' || fail "plans differ"
import json, math
def alike(a, b):
    if isinstance(a, dict): return a.keys() == b.keys() and all(alike(a[k], b[k]) for k in a if k != "center")
    if isinstance(a, list): return len(a) == len(b) and all(map(alike, a, b))
    return math.isclose(a, b, rel_tol=1e-12, abs_tol=1e-12) if isinstance(a, float) else a == b
raise SystemExit(not alike(json.load(open("by-header.json")), json.load(open("by-camera.json"))))
END
exits 0 "$bin/ldi-plan" bare/center.exr --camera lens.json --fstop 100 -o narrow.json
changes narrow.json by-camera.json --fstop

# Frames and names.
fails_saying 2 'several cameras: give --camera-name, one of /rig/left, /rig/shot' "$bin/ldi-plan" bare/center.exr --camera animated.json -o x.json
shot=(bare/center.exr --camera animated.json --camera-name shot)
fails_saying 2 'rig/shot> is animated: give --camera-frame' "$bin/ldi-plan" "${shot[@]}" -o x.json
fails_saying 1 'animated.json: /rig/shot: is known at frames 1 and 2, but not at 1.5' "$bin/ldi-plan" "${shot[@]}" --camera-frame 1.5 -o x.json
for frame in 1 2; do exits 0 "$bin/ldi-plan" "${shot[@]}" --camera-frame $frame -o at-$frame.json; done
changes at-1.json at-2.json --camera-frame

# USD needs its library: one line says how to get it, and nothing is written.
printf '#!/bin/bash\nexec python3 -S "$@"\n' >no_pxr && chmod +x no_pxr # it has no packages
echo '#usda 1.0' >shot.usda
export SPARSELENS_USD_PYTHON=./no_pxr
advice='has no pxr, the library of USD: pip install usd-core, or name another Python by SPARSELENS_USD_PYTHON'
fails_saying 1 "shot.usda: .*$advice" "$bin/ldi-plan" bare/center.exr --camera shot.usda -o x.json
fails_saying 1 "shot.usda: .*$advice" "$bin/ldi-warp" bare/center.exr --camera shot.usda -o x.exr
fails_saying 1 "x.usda: .*$advice" "$bin/ldi-plan" --camera animated.json --camera-name shot --size 96x54 --cameras x.usda
exits 1 "$bin/ldi-plan" views/center.exr -o x.json --cameras x.usdc
says "x.usdc: .*$advice" stderr
echo 'raise SystemExit("taken from the current folder")' >pxr.py
fails_saying 1 "$advice" "$bin/ldi-plan" bare/center.exr --camera shot.usda -o x.json
SPARSELENS_USD_PYTHON=./not_there fails_saying 1 'shot.usda: cannot start ./not_there, which reads and writes USD \(No such file' \
    "$bin/ldi-plan" bare/center.exr --camera shot.usda -o x.json
SPARSELENS_USD_PYTHON=false fails_saying 1 'shot.usda: false fails' "$bin/ldi-plan" bare/center.exr --camera shot.usda -o x.json

# What cannot be: one line.
fails_saying 2 'give a centre view, or --camera SHOT.usd and --cameras VIEWS.usd' "$bin/ldi-plan" --camera lens.json
fails_saying 2 'give a centre view' "$bin/ldi-plan" --camera lens.json --cameras x.json
fails_saying 2 '--output: a plan needs a centre view' "$bin/ldi-plan" --camera lens.json --cameras x.usda -o x.json
fails_saying 2 '--output is required' "$bin/ldi-plan" views/center.exr
fails_saying 2 'would overwrite the input shot.usda' "$bin/ldi-plan" --camera shot.usda --cameras shot.usda
fails_saying 2 'lens.json has no render settings with a resolution: give --size' "$bin/ldi-plan" --camera lens.json --cameras x.usda
fails_saying 2 '--size' "$bin/ldi-plan" --camera lens.json --cameras x.usda --size 96
fails_saying 2 '--up-axis' "$bin/ldi-plan" --camera lens.json --cameras x.usda --up-axis X
fails_saying 2 '--camera-name' "$bin/ldi-plan" views/center.exr -o x.json --camera-name a
fails_saying 1 'missing.json' "$bin/ldi-plan" --camera missing.json --cameras x.usda
fails_saying 1 'planned.json: has no cameras as usd_cameras.py writes them' "$bin/ldi-plan" --camera planned.json --cameras x.usda
fails_saying 1 'bare/center.exr: does not say where its camera stands \(worldToCamera\): give its --camera' \
    "$bin/ldi-plan" bare/center.exr "${lens[@]}" -o x.json --cameras x.usda
[ ! -e x.usda ] && [ ! -e x.usdc ] || fail "a failure wrote a layer"
