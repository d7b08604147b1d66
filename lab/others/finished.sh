#!/bin/bash
# Makes pictures with dof-finish from five views and rays over the lens, in the folder that lab/denoise filled:
# finished_N.exr and, with each view and render denoised, finished_N.denoised.exr, with N rays in total. For a scene of
# dof-trace the rays are divided as by ldi-plan --rays for five views, and half_N.exr has half of them in the views; views
# are twice as fine if they have four rays per pixel; a focus pull is finished as in more.sh, with the views of one frame,
# rays for each frame, and those of two frames before and after. advice.json says what ldi-plan advises. For ready-made
# pictures (SCENE is -) all views are finished with drt_64.exr and drt_16.exr, or the views of four samples with each
# folder halves-N of two renders.
#
#   finished.sh BIN_DIR SCENE [WIDTHxHEIGHT LIGHT PYTHON]
#
# Seconds include all rays and tools, one after the other.
set -euo pipefail
others=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
scene=$2 size=${3-} light=${4-} python=${5-}
. "$others/common.inc" "$1" "$others"
trace() { dof-trace "$scene" --size "$size" "$@" >/dev/null; }

# seconds CAMERA NAME...: the sum of camera.json's seconds whose names begin with any NAME.
seconds() {
    python3 - "$@" <<'END'
import json, sys
print(sum(s for name, s in json.load(open(sys.argv[1]))["seconds"].items() if name.startswith(tuple(sys.argv[2:]))))
END
}
# timed COMMAND...: stores its seconds in $took.
timed() {
    local begin=${EPOCHREALTIME/./}
    "$@" 2>/dev/null
    took=$(awk -v us=$((${EPOCHREALTIME/./} - begin)) 'BEGIN { print us / 1e6 }')
}
# row FILE RAYS WAY SECONDS...: adds a picture to the folder's camera.json.
row() {
    python3 - "$@" <<'END'
import json, sys
file, rays, way, *seconds = sys.argv[1:]
camera = json.load(open("camera.json"))
camera["seconds"][file] = round(sum(map(float, seconds)), 3)
camera["others"] = [o for o in camera.get("others", []) if o["file"] != file] + [
    {"file": file, "renderer": "views and rays", "processor": way, "budget": f"{rays} rays", "rays": int(rays)}]
json.dump(camera, open("camera.json", "w"), indent=1)
END
}
gather() { # WORD_OF_LDI_WARP...: writes gathered.exr at the size of the rays
    ldi-warp "$@" -o views.ldi.exr && dof-gather views.ldi.exr "${fine[@]}" -o gathered.exr
}
# finish NAME RAYS WAY VIEWS_SECONDS RENDER_1 RENDER_2 SAMPLES RENDERS_SECONDS [OPTION...]: from gathered.exr
finish() {
    local gathered=$took
    timed dof-finish gathered.exr "$5" "$6" --samples "$7" "${@:9}" -o "$1.exr"
    row "$1.exr" "$2" "$3" "$4" "$gathered" "$took" "$8"
}

# advise OPTION...: writes into advice.json what ldi-plan advises: views, rays, or both.
advise() {
    for rays in 5 16 20 64 80 100 256 320 400 1280; do
        ldi-plan center.exr "$@" -o - --rays $rays 2>/dev/null | python3 -c 'import json, sys
rays = json.load(sys.stdin)["rays"]
print(sys.argv[1], "rays" if rays["alone"] else "both" if rays["per_render"] else "views")' $rays
    done | python3 -c 'import json, sys; print(json.dumps(dict(line.split() for line in sys.stdin)))' >advice.json
}
# ready AT COST SAMPLES_1 SAMPLES_2 RENDER_1 RENDER_2: finishes the views in the folder AT with two ready-made renders,
# whose seconds are in the file COST
ready() {
    local at=$1 cost=$2 first=$5 second=$6 words denoised options rays word names=()
    rays=$(python3 -c 'import json, sys; print(sum(map(int, sys.argv[2:])) + 5 * json.load(open(sys.argv[1]))["view_spp"])' "$at/camera.json" "$3" "$4")
    mapfile -t words < <(views "$at" exr | tr ' ' '\n')
    mapfile -t denoised < <(views "$at" denoised.exr | tr ' ' '\n' | grep '[.]exr$')
    for word in "${words[@]}"; do [[ $word != *.exr ]] || names+=("$(basename "$word" .exr)"); done
    timed gather "${words[@]}"
    finish finished_$rays $rays finished "$(seconds "$at/camera.json" "${names[@]/%/.exr}")" "$first.exr" "$second.exr" $3,$4 \
        "$(seconds "$cost" "$(basename "$first").exr" "$(basename "$second").exr")"
    timed gather "${words[@]}" --denoised "${denoised[@]}"
    options=(--denoised "$first.denoised.exr" "$second.denoised.exr")
    finish finished_$rays.denoised $rays 'finished, denoised' "$(seconds "$at/camera.json" "${names[@]/%/.denoised}")" "$first.exr" "$second.exr" $3,$4 \
        "$(seconds "$cost" "$(basename "$first").denoised" "$(basename "$second").denoised")" "${options[@]}"
}
if [ "$scene" = - ]; then
    fine=()
    shopt -s nullglob
    pairs=(halves-*/)
    for pair in "${pairs[@]}"; do
        half=$((${pair//[!0-9]/} / 2))
        ready 4 $pair/cost.json $half $half $pair/rays_1 $pair/rays_2
    done
    if [ ${#pairs[@]} -eq 0 ]; then
        [ -e drt_64.exr ] && [ -e drt_16.exr ] || { echo "there are no drt_64.exr and drt_16.exr" >&2; exit 1; }
        for at in . */; do
            [ ! -e "$at/camera.json" ] || [ ! -e "$at/center.denoised.exr" ] || ready "$at" camera.json 64 16 drt_64 drt_16
        done
    fi
    mapfile -t words < <(views . exr | tr ' ' '\n')
    advise "${words[@]:0:8}"
    rm -f views.ldi.exr gathered.exr
    exit
fi

# NAME RAYS LENS: rays in total, and how many of them go through the lens
divisions=('finished 80 40' 'finished 320 280' 'finished 1280 1240' 'half 20 10' 'half 320 160' 'half 1280 640')
# divided NAME RAYS LENS: sets $name, $rays, $lens, and $samples of each view, which are twice as $fine if that many pay.
divided() {
    name=$1 rays=$2 lens=$3 samples=$((($2 - $3) / 5)) fine=()
    [ $samples -lt 4 ] || fine=(--supersample 2)
}
: >jobs
for words in "${divisions[@]}"; do
    divided $words
    trace --light "$light" --views 4 --spp $samples "${fine[@]}" --halves $lens -o $name-$rays
    [ $name = finished ] || continue # half of the rays in the views: for comparison, not denoised
    for guide in albedo normal; do trace --light $guide --views 0 --spp 1 --halves $lens -o $name-$rays/$guide; done
    for k in 1 2; do echo "$name-$rays/rays_$k.exr $name-$rays/albedo/rays_$k.exr $name-$rays/normal/rays_$k.exr noisy" >>jobs; done
    [ $samples -lt 4 ] && guides= || guides=fine-
    for view in center view_{0..3}; do echo "$name-$rays/$view.exr ${guides}albedo/$view.exr ${guides}normal/$view.exr clean" >>jobs; done
done
"$python/bin/python" "$others/denoise.py"
for words in "${divisions[@]}"; do
    divided $words
    at=$name-$rays of=$name-$rays/cost.json
    renders="$at/rays_1.exr $at/rays_2.exr $((lens / 2)),$((lens / 2))"
    timed gather $at/center.exr $at/view_[0-3].exr
    mv $at/camera.json $of # its views are no budget of their own
    finish ${name}_$rays $rays $name "$(seconds $of center.exr view_0.exr view_1.exr view_2.exr view_3.exr)" $renders "$(seconds $of rays_1.exr rays_2.exr)"
    [ $name = finished ] || continue
    [ $at != finished-80 ] || mv views.ldi.exr finished_80.ldi.exr
    timed gather $at/center.exr $at/view_[0-3].exr --denoised $at/center.denoised.exr $at/view_[0-3].denoised.exr
    finish ${name}_$rays.denoised $rays "finished, denoised" "$(seconds $of center.denoised view_{0..3}.denoised)" $renders \
        "$(seconds $of rays_1.denoised rays_2.denoised)" --denoised $at/rays_1.denoised.exr $at/rays_2.denoised.exr
done
advise

focus=$(python3 -c 'import json; print(json.load(open("camera.json"))["focus_distance"])')
for frame in {01..16}; do
    at=$(awk -v f="$focus" -v k="$frame" 'BEGIN { print f * (1 + .1 * (k - 1) / 15) }')
    trace --light "$light" --views 0 --spp 1 --halves 40 --seed $((10 + 10#$frame)) --focus-distance "$at" -o pull
    for k in 1 2; do mv pull/rays_$k.exr pull/rays_$k.$frame.exr; done
    dof-gather finished_80.ldi.exr --supersample 2 --focus-distance "$at" -o pull/gathered.$frame.exr 2>/dev/null
done
dof-finish pull/gathered.##.exr pull/rays_1.##.exr pull/rays_2.##.exr --frames 1-16 --neighbours 2 -o finished_80.pull.####.exr 2>/dev/null
rm -rf pull views.ldi.exr gathered.exr
