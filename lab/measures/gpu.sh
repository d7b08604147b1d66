# Where the time of `--device` goes: milliseconds by --stats of the second of two pictures over one LDI, beside the CPU
# with 2 threads and with all, in one run. $device is a part of the device's name (default: gpu; llvmpipe is Mesa's
# software device), $sizes and $scenes may be others. 8 minutes with a GPU. Works on an archive, too: bash gpu.sh ARCHIVE/bin
. "$(dirname "$0")/common.inc" "$1"

device=${device-gpu}
# ms STEP[|STEP...]: the milliseconds of these steps together, in the last line of stats.json.
ms() {
    tail -n 1 stats.json | tr ',{}' '\n' | sed -nE 's/^"([a-z -]+)":([0-9.e+-]+)$/\1\t\2/p' |
        awk -F '\t' -v names="$1" 'BEGIN { n = split(names, want, "|") }
            { for (i = 1; i <= n; ++i) if ($1 == want[i]) sum += $2 } END { printf "%.0f", sum }'
}
# row WORDS PASSES COMMAND...: runs it, and prints a row.
row() {
    rm -f stats.json
    local begin=$EPOCHREALTIME
    "${@:3}" --stats stats.json >log 2>&1 || { echo "gpu.sh: ${*:3}: $(tail -n 1 log)" >&2; exit 1; }
    echo "| $size | $scene | $1 | $(awk -v a="$begin" -v b="$EPOCHREALTIME" 'BEGIN { printf "%.2f", b - a }') | $(ms read) | $(ms 'picture|warp') | $(ms gather) | $(ms upload) | $(ms "$2") | $(ms download) | $(ms write) |"
}
echo "| size | scene | what | whole process, s | read | picture or warp | gathering in the picture | upload | programs | download | write |"
echo "|---|---|---|---|---|---|---|---|---|---|---|"
for size in ${sizes-1920x1080 3840x2160}; do
    for scene in ${scenes-fence macro mirror}; do
        trace "$scene.$size" $scene --size $size --spp 4
        [ $scene = macro ] && focus=1:.42,2:.45 || focus=1:4,2:5
        mapfile -t views < <(five_views "$scene.$size" | tr ' ' '\n')
        for by in "cpu 2" "cpu" "$device"; do
            read -r at threads <<<"$by"
            on="${at/cpu/CPU}${threads:+, $threads threads}"
            words=(--device "$at" ${threads:+--threads "$threads"})
            row "warp of five views, $on" 'land|surfaces|differences|vote|emit|sums|fill' ldi-warp "${views[@]}" "${words[@]}" -o "$scene.$size.exr"
            for quality in normal final; do
                row "pull, second frame, $quality, $on" lens dof-gather "$scene.$size.exr" --quality $quality "${words[@]}" --frames 1-2 --focus-distance $focus -o pull.#.exr
            done
            [ $size != 1920x1080 ] || row "selective, $on" selective dof-gather "$scene.$size.exr" --method selective "${words[@]}" -o selective.exr
        done
    done
done
