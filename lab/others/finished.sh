#!/bin/bash
# Makes pictures with dof-finish from five views and rays over the lens, in the folder that lab/denoise filled:
# finished_N.exr and, with each render denoised, finished_N.denoised.exr, with N rays in total. For a scene of dof-trace the
# rays are divided as by ldi-plan --rays for five views, and half_N.exr has half of them in the views; views are twice as
# fine if they have four rays per pixel; a focus pull is finished as in more.sh, with the views of one frame and rays for
# each frame. For ready-made pictures (SCENE is -) all views are finished with drt_64.exr and drt_16.exr.
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
gather() { # VIEWS...: writes gathered.exr at the size of the rays
    ldi-warp "$@" -o views.ldi.exr && dof-gather views.ldi.exr "${fine[@]}" -o gathered.exr
}

if [ "$scene" = - ]; then
    fine=()
    [ -e drt_64.exr ] && [ -e drt_16.exr ] || { echo "there are no drt_64.exr and drt_16.exr" >&2; exit 1; }
    for at in . */; do
        [ -e "$at/camera.json" ] && [ -e "$at/center.denoised.exr" ] || continue
        rays=$(python3 -c 'import json, sys; print(80 + 5 * json.load(open(sys.argv[1]))["view_spp"])' "$at/camera.json")
        mapfile -t words < <(views "$at" exr | tr ' ' '\n')
        shown=()
        for word in "${words[@]}"; do [[ $word != *view_*.exr ]] || shown+=("$(basename "$word")"); done
        timed gather "${words[@]}"
        cost=("$took" "$(seconds "$at/camera.json" center.exr "${shown[@]}")")
        timed dof-finish gathered.exr drt_64.exr drt_16.exr --samples 64,16 -o finished_$rays.exr
        row finished_$rays.exr $rays finished "${cost[@]}" "$took" "$(seconds camera.json drt_64.exr drt_16.exr)"
        timed dof-finish gathered.exr drt_64.exr drt_16.exr --samples 64,16 --denoised drt_64.denoised.exr,drt_16.denoised.exr -o finished_$rays.denoised.exr
        row finished_$rays.denoised.exr $rays 'finished, denoised' "${cost[@]}" "$took" "$(seconds camera.json drt_64.denoised drt_16.denoised)"
    done
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
done
"$python/bin/python" "$others/denoise.py"
for words in "${divisions[@]}"; do
    divided $words
    at=$name-$rays of=$name-$rays/camera.json
    timed gather $at/center.exr $at/view_[0-3].exr
    cost=("$took" "$(seconds $of center.exr view_)")
    timed dof-finish gathered.exr $at/rays_{1,2}.exr -o ${name}_$rays.exr
    row ${name}_$rays.exr $rays $name "${cost[@]}" "$took" "$(seconds $of rays_1.exr rays_2.exr)"
    mv $of $at/cost.json # its views are no budget of their own
    [ $name = finished ] || continue
    timed dof-finish gathered.exr $at/rays_{1,2}.exr --denoised $at/rays_1.denoised.exr,$at/rays_2.denoised.exr -o ${name}_$rays.denoised.exr
    row ${name}_$rays.denoised.exr $rays "finished, denoised" "${cost[@]}" "$took" "$(seconds $at/cost.json rays_1.denoised rays_2.denoised)"
    [ $at != finished-80 ] || mv views.ldi.exr finished_80.ldi.exr
done

focus=$(python3 -c 'import json; print(json.load(open("camera.json"))["focus_distance"])')
for frame in {01..16}; do
    at=$(awk -v f="$focus" -v k="$frame" 'BEGIN { print f * (1 + .1 * (k - 1) / 15) }')
    trace --light "$light" --views 0 --spp 1 --halves 40 --seed $((10 + 10#$frame)) --focus-distance "$at" -o pull
    dof-gather finished_80.ldi.exr --supersample 2 --focus-distance "$at" -o pull/gathered.exr 2>/dev/null
    dof-finish pull/gathered.exr pull/rays_{1,2}.exr -o finished_80.pull.00$frame.exr 2>/dev/null
done
rm -rf pull views.ldi.exr gathered.exr
