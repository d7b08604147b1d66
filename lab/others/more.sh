#!/bin/bash
# Pictures that lab/rivals compares in addition to lab/denoise, for a scene of dof-trace, in the folder that lab/denoise
# filled: averages of views over the lens, views of twice the size with a quarter of the samples, and a focus pull to
# 1.1 times its distance in 16 frames: by rays over the lens, by these denoised, and by averages. Each frame has its own
# random numbers, as in renderers.
#
#   more.sh BIN_DIR SCENE WIDTHxHEIGHT LIGHT PYTHON
set -euo pipefail
others=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
scene=$2 size=$3 light=$4 python=$5
. "$others/common.inc" "$1" "$others"
trace() { dof-trace "$scene" --size "$size" "$@" >/dev/null; }
cp jobs jobs.denoised
: >jobs

# Averages with as many rays, four per view if there are enough views.
for of in '5 1' '5 4' '20 4' '80 4'; do
    read -r views samples <<<"$of"
    rays=$((views * samples))
    rm -rf accumulated-$rays
    trace --light "$light" --views 0 --lens-views "$views" --spp "$samples" -o accumulated-$rays
    begin=$(date +%s.%N)
    dof-accumulate accumulated-$rays/lens_*.exr -o accumulated_$rays.exr 2>/dev/null
    python3 - "$rays" "$views" "$begin" "$(date +%s.%N)" <<'END'
import json, sys
rays, views, begin, end = sys.argv[1:]
traced = json.load(open(f"accumulated-{rays}/camera.json"))["seconds"]
camera = json.load(open("camera.json"))
file = f"accumulated_{rays}.exr"
camera["seconds"][file] = round(sum(s for name, s in traced.items() if name.startswith("lens_")) + float(end) - float(begin), 3)
camera["others"] = [o for o in camera.get("others", []) if o["file"] != file] + [
    {"file": file, "renderer": "accumulated lens views", "processor": "", "budget": f"{rays} rays", "rays": int(rays)}]
json.dump(camera, open("camera.json", "w"), indent=1)
END
done

# Finer views.
for guide in albedo normal; do trace --light $guide --views 4 --spp 64 --supersample 2 -o fine-$guide; done
rm -f fine-{albedo,normal}/camera.json # not a budget of their own
for samples in 4 16 64 256; do
    trace --light "$light" --views 4 --spp $samples --supersample 2 -o fine-$samples
    for name in center view_{0..3}; do
        echo "fine-$samples/$name.exr fine-albedo/$name.exr fine-normal/$name.exr clean" >>jobs
    done
done

# The focus pull.
focus=$(python3 -c 'import json; print(json.load(open("camera.json"))["focus_distance"])')
for frame in {01..16}; do
    at=$(awk -v f="$focus" -v k="$frame" 'BEGIN { print f * (1 + .1 * (k - 1) / 15) }')
    for kind in "$light" albedo normal; do
        trace --light "$kind" --views 0 --spp 1 --reference 80 --seed $((10 + 10#$frame)) --focus-distance "$at" -o "pull/$kind-$frame"
    done
    mv "pull/$light-$frame/reference.exr" drt_80.pull.00$frame.exr
    echo "drt_80.pull.00$frame.exr pull/albedo-$frame/reference.exr pull/normal-$frame/reference.exr frame" >>jobs
    dof-accumulate accumulated-80/lens_*.exr --focus-distance "$at" -o accumulated_80.pull.00$frame.exr 2>/dev/null
done
"$python/bin/python" "$others/denoise.py"
rm -rf pull
