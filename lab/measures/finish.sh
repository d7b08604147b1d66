# dof-finish beside its parents, as a whole and by block: all scenes of the laboratory at 160x90, with 32, 80 and 320
# rays of which 20, 40 and 40 are in five views; overscan of 16 pixels; and the sets of ../shared/views with 64 + 16 rays
# over the lens; each without and with denoiser. 15 CPU minutes; needs PyPI.
# Code: src/finish src/dof src/warp
. "$(dirname "$0")/common.inc" "$1"
others=$(cd "$(dirname "$0")/../others" && pwd)
. "$others/common.inc" "$bin" "$others"
environment "$PWD/environment" pyoidn OpenEXR numpy
python=$PWD/environment/bin/python
: >blocks

# finished NAME FOLDER REF_1 REF_2 RAYS_1 RAYS_2 SAMPLES WORD_OF_LDI_WARP...: two rows
finished() {
    local name=$1 at=$2 first=$3 second=$4 one=$5 two=$6 samples=$7 word options=() views=()
    ldi-warp "${@:8}" -o l.exr && dof-gather l.exr -o g.exr
    dof-finish g.exr "$one" "$two" --samples "$samples" -o f.exr 2>/dev/null
    oiiotool "$one" --mulc "$(awk -F, '{ print $1 / ($1 + $2) }' <<<"$samples")" "$two" --mulc "$(awk -F, '{ print $2 / ($1 + $2) }' <<<"$samples")" --add -d float -o mean.exr
    "$python" "$others/blocks.py" "$name" "$first" "$second" f.exr g.exr mean.exr
    mkdir -p "$at/denoised"
    for word in "${@:8}"; do [[ $word != *.exr ]] || views+=("$word"); done
    [ -e "$at/denoised/done" ] || {
        mkdir -p "$at/noisy"
        for word in "${views[@]}" "$one" "$two"; do cp "$word" "$at/noisy/" && echo "$at/noisy/$(basename "$word") - - alone"; done >jobs
        "$python" "$others/denoise.py"
        mv "$at"/noisy/*.denoised.exr "$at/denoised/" && rm -r "$at/noisy" && touch "$at/denoised/done"
    }
    denoised() { for word; do echo "$at/denoised/$(basename "$word" .exr).denoised.exr"; done; }
    mapfile -t options < <(denoised "${views[@]}")
    ldi-warp "${@:8}" --denoised "${options[@]}" -o l.exr && dof-gather l.exr -o g.exr
    mapfile -t options < <(denoised "$one" "$two")
    dof-finish g.exr "$one" "$two" --samples "$samples" --denoised "${options[@]}" -o f.exr 2>/dev/null
    "$python" "$others/blocks.py" "$name, denoised" "$first" "$second" f.exr g.exr mean.exr "${options[@]}"
}

echo '| scene, rays | gathered | mean of the rays | denoised | finished | over the best | blocks beyond 2 | most |'
echo '|---|---|---|---|---|---|---|---|'
scenes=$(dof-trace --help | sed -nE 's/.*SCENE :\{(.*)\}.*/\1/p' | tr , ' ')
for scene in ${FINISH_SCENES-$scenes}; do
    trace "$scene" "$scene" --size 160x90 --light area --views 0 --spp 1 --halves 4096 --seed 9
    for rays in 32 80 320 80+16; do
        case $rays in 32) words=(--spp 4 --halves 12) ;; 80) words=(--spp 8 --halves 40) ;; 320) words=(--spp 8 --halves 280) ;; *) words=(--spp 8 --halves 40 --overscan 16) ;; esac
        at=$scene-$rays
        trace "$at" "$scene" --size 160x90 --light area --views 4 "${words[@]}"
        finished "$scene, $rays" "$at" "$scene/rays_1.exr" "$scene/rays_2.exr" "$at/rays_1.exr" "$at/rays_2.exr" 1,1 "$at"/center.exr "$at"/view_[0-3].exr
    done
done
for of in ${FINISH_SETS-"$shared"/views/*/}; do
    [ -e "$of/drt_256.exr" ] && [ -e "$of/reference.exr" ] || continue
    name=$(basename "$of")
    # shellcheck disable=SC2046
    finished "$name, 80" "$name" "$of/reference.exr" "$of/drt_256.exr" "$of/drt_64.exr" "$of/drt_16.exr" 64,16 $(five_views "${of%/}")
done
awk '{ all += $1; worse += $2 } END { printf "\n%.2f %% of %d blocks have at most twice the least error of the parents.\n", 100 - 100 * worse / all, all }' blocks
