#!/bin/bash
# Six frames of animated cameras compared with Cycles' own lens, frame by frame; an element over a transparent film; and
# two elements that hold each other out.
#   bash animation.sh BIN_DIR [WIDTHxHEIGHT [TRUTH_SAMPLES [SAMPLES]]]      480x270, 96, 16 a view
. "$(dirname "$0")/common.sh"
size=${2:-480x270} truth_samples=${3:-96} samples=${4:-16}

# rendered KIND LAST: renders the views of frames 1 to LAST of KIND.blend, and the truth, into the folder KIND.
rendered() {
    in_blender "$1.blend" -P "$views" -- "${plain[@]}" -o "$1" --frames "1-$2" --samples "$samples"
    in_blender "$1.blend" -P "$variants" -- render "$truth_samples" 1 "$2" "$PWD/$1/truth.####.exr"
}

# error KIND FRAME: dB of the picture from the views.
error() {
    local frame
    frame=$(printf %04d "$2")
    defocused picture.exr "$1/center.$frame.exr" "$1"/view_{0..3}."$frame.exr"
    decibels picture.exr "$1/truth.$frame.exr"
}

in_blender -P "$scene" -- CYCLES "$size" save "$PWD/still.blend"
rendered still 1
still=$(error still 1)
echo "still: $still dB ($size, $samples samples a view, truth of $truth_samples)"

# Keys, a path, keys and a Track To: every frame is as good as the still, to within 1 dB.
for kind in keys path track; do
    variant still $kind
    rendered $kind 6
    figures=()
    for frame in {1..6}; do figures+=("$(error $kind "$frame")"); done
    echo "$kind, frames 1 to 6: ${figures[*]} dB"
    for figure in "${figures[@]}"; do better "$figure" "$still" -1 "$kind"; done
    unlike $kind/truth.0001.exr $kind/truth.0006.exr 30 # the camera really moved
done

# A transparent film: half of the partly covered pixels have the depth of the sky. Compared with the still, edges in
# focus over nothing cost 2 dB (38.4 with Blender 3.4, 39.7 from 4.3 on); at infinity they would cost 7.
variant still film
rendered film 1
film=$(error film 1)
echo "transparent film: $film dB"
better "$film" 38 0 "transparent film"

# The recipe of docs/comp.md instead of holdouts: two elements, rendered apart and each held out by the other, add up to
# the whole.
for part in ball others; do
    variant still $part
    in_blender $part.blend -P "$views" -- "${plain[@]}" -o $part --samples "$samples"
    "$bin/ldi-warp" $part/center.exr $part/view_*.exr -o $part.ldi.exr
done
"$bin/dof-gather" ball.ldi.exr --holdout others.ldi.exr --holdout-defocused -o ball.exr
"$bin/dof-gather" others.ldi.exr --holdout ball.ldi.exr --holdout-defocused -o others.exr
oiiotool ball.exr others.exr --add -o together.exr
together=$(decibels together.exr still/truth.0001.exr)
echo "held out by each other: $together dB"
better "$together" "$still" -0.1 "two elements that hold each other out"
