# The cost of five views of 4 samples at common sizes, with blur of the same width relative to the picture: CPU seconds,
# wall seconds and peak MB of one run each, beside oiiotool --flatten of the same LDI in the same run. $sizes may give
# other sizes. 8 minutes, and 3 to trace.
. "$(dirname "$0")/common.inc" "$1"

runs=1
row() { # STEP FIGURES
    local cpu clock
    IFS=' |' read -r cpu clock _ <<<"$2"
    awk -v row="| $size | $scene | $1 | $2 |" -v a="$cpu" -v b="$flat_cpu" -v c="$clock" -v d="$flat_clock" \
        'BEGIN { printf "%s %.2f | %.2f |\n", row, a / b, c / d }'
}
echo "| size | scene | step | CPU seconds | by the clock | peak MB | times flatten's CPU seconds | ... by the clock |"
echo "|---|---|---|---|---|---|---|---|"
for size in ${sizes-1920x1080 3840x2160}; do
    for scene in fence grass mirror mist macro; do
        trace "$scene.$size" $scene --size $size --spp 4
        # shellcheck disable=SC2046
        warp=$(cost ldi-warp $(five_views "$scene.$size") -o ldi.exr)
        flatten=$(cost oiiotool ldi.exr --flatten -o flat.exr)
        IFS=' |' read -r flat_cpu flat_clock _ <<<"$flatten"
        row "\`oiiotool --flatten\`" "$flatten"
        row "\`ldi-warp\`" "$warp"
        row "\`dof-gather\`" "$(cost dof-gather ldi.exr -o picture.exr)"
        for fstop in 1.5 2.8; do
            [ $scene != macro ] || row "\`dof-gather --fstop $fstop\`" "$(cost dof-gather ldi.exr --fstop $fstop -o picture.exr)"
        done
        [ $scene != fence ] || row "\`dof-gather --quality final\`" "$(cost dof-gather ldi.exr --quality final -o picture.exr)"
    done
done
