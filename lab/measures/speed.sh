# What five views of 4 samples cost at the sizes that people work in, with a blur as wide in the picture at each: CPU seconds,
# seconds by the clock and peak MB, the best of three runs, beside oiiotool --flatten of the same LDI. 15 minutes.
. "$(dirname "$0")/common.inc" "$1"

echo "| scene, size, step | CPU seconds | by the clock | peak MB | times flatten's CPU seconds |"
echo "|---|---|---|---|---|"
row() { # LABEL COMMAND...
    local figures
    figures=$(cost "${@:2}")
    [ "${2##*/}" != oiiotool ] || flatten=${figures%% *}
    echo "| $1 | $figures | $(awk -v a="${figures%% *}" -v b="$flatten" 'BEGIN { printf "%.2f", a / b }') |"
}
for size in 1920x1080 3840x2160; do
    for scene in fence grass macro mirror mist; do
        [[ $size = 1920x1080 || $scene = fence ]] || continue
        trace "$scene.$size" $scene --size $size --spp 4
        # shellcheck disable=SC2046
        ldi-warp $(five_views "$scene.$size") -o ldi.exr 2>/dev/null
        row "$scene, $size, \`oiiotool --flatten\`" oiiotool ldi.exr --flatten -o flat.exr
        # shellcheck disable=SC2046
        row "\`ldi-warp\`" ldi-warp $(five_views "$scene.$size") -o ldi.exr
        row "\`dof-gather --lens-radius 0\`" dof-gather ldi.exr --lens-radius 0 -o picture.exr
        for quality in draft normal final; do
            row "\`dof-gather --quality $quality\`" dof-gather ldi.exr --quality $quality -o picture.exr
        done
    done
done
