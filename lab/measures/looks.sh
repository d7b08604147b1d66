# Each look of the lens on four scenes, gathered from five views of 16 samples at final quality, compared with 1024 rays
# through the same lens. Looks of the table that have no line here are measured at 0.7. For lamps, 8x8 pixels are
# averaged to one, because their rays are noisy. Also the cost of each look: CPU time of the gather at 1920x1080,
# relative to the round lens. 25 minutes; 3 if the references are kept.
. "$(dirname "$0")/common.inc" "$1"
lenses=$(cd "$(dirname "$0")/../../share/lenses" && pwd)
scenes=(fence mist grass lamps)

for scene in "${scenes[@]}"; do
    trace "$scene.views" "$scene" --size 640x360
    # shellcheck disable=SC2046
    ldi-warp $(five_views "$scene.views") -o "$scene.ldi.exr" 2>/dev/null
done
trace large fence --size 1920x1080 --spp 4
# shellcheck disable=SC2046
ldi-warp $(five_views large) -o large.ldi.exr

coarse() { oiiotool "$1" --ch R,G,B --resize:filter=box 80x45 -o "$2"; }
figure() { # SCENE PICTURE REFERENCE
    if [ "$1" = lamps ]; then
        coarse "$2" picture.8.exr
        coarse "$3" reference.8.exr
        db picture.8.exr reference.8.exr
    else
        db "$2" "$3"
    fi
}
seconds() { cost dof-gather large.ldi.exr "$@" -o large.exr | cut -d ' ' -f 1; }
round=$(seconds)
measured=
look() { # LABEL NAME OPTION...
    local label=$1 name=$2 cells= scene
    measured+=" $* "
    shift 2
    for scene in "${scenes[@]}"; do
        trace "$scene.$name" "$scene" --size 640x360 --views 0 --spp 1 --reference 1024 "$@"
        dof-gather "$scene.ldi.exr" --quality final "$@" -o picture.exr
        cells+=" $(figure "$scene" picture.exr "$scene.$name/reference.exr") |"
    done
    echo "| $label |$cells $(awk -v a="$(seconds "$@")" -v b="$round" 'BEGIN { printf "%.2f", a / b }') |"
}

echo "| look | fence, dB | mist | grass | lamps | time |"
echo "|---|---|---|---|---|---|"
look round round
look '6 blades' blades --blades 6 --blade-rotation 15
look 'squeeze 2' squeeze --squeeze 2
look "a mirror lens's picture" mirror --aperture "$lenses/mirror.exr"
look 'spherical 0.7' spherical --spherical 0.7
look "cat's eye 1" cat --cat-eye 1
look "cat's eye 1, darkening" dark --cat-eye 1 --cat-eye-darkening
look 'axial chromatic 0.1' axial --axial-chromatic 0.1
look 'field curvature 0.3' curvature --field-curvature 0.3
look 'astigmatism 0.3' astigmatism --astigmatism 0.3
look 'tilt 10,5' tilt --tilt 10,5
look 'breathing 1' breathing --breathing 1
for number in $(dof-gather --help | sed -nE '/^Lens looks:$/,/^Highlights:$/s/^  (--[a-z-]+) [A-Z]{1,3}( .*)?$/\1/p'); do
    [[ $measured == *" $number "* || $number == --blade-* ]] || look "${number#--} 0.7" "${number#--}" "$number" 0.7
done
