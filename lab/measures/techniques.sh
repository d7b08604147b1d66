# What each technique is worth: each switched off by itself, by an option or by one line of the code, and how many dB the picture
# then gains (at final quality, from five views of 16 samples). An hour, most of it for building.
. "$(dirname "$0")/common.inc" "$1"
. "$(dirname "$0")/variants.inc"
scenes=(fence grass mirror)
for scene in "${scenes[@]}"; do
    trace $scene.truth "$scene" --size 640x360 --views 0 --reference 2048
    trace $scene "$scene" --size 640x360
    ln -sfn $scene.truth/reference.exr $scene.exr
done
for scene in yard pelt; do
    [ -e "$shared/views/$scene" ] || continue
    ln -sfn "$shared/views/$scene" $scene
    ln -sfn "$shared/views/$scene/reference.exr" $scene.exr
    scenes+=($scene)
done

figures() { # WARP_OPTIONS GATHER_OPTIONS: of each scene, one a line
    local scene
    for scene in "${scenes[@]}"; do
        # shellcheck disable=SC2046,SC2086
        ldi-warp $1 $(five_views "$scene") -o - 2>/dev/null | dof-gather - --quality final $2 -o picture.exr 2>/dev/null
        db picture.exr "$scene.exr"
        echo
    done
}
row() { # LABEL FIGURES
    paste <(echo "$2") <(echo "${3-}") | awk -v label="$1" 'BEGIN { printf "| %s |", label }
        NF == 2 { printf " %+.2f |", $1 - $2 } NF == 1 { printf " %.2f |", $1 } END { print "" }'
}
printf '| |%s\n' "$(printf ' %s |' "${scenes[@]}")"
printf '|---|%s\n' "$(printf -- '---|%.0s' "${scenes[@]}")"
all=$(figures "" "")
row "everything on, dB" "$all"
row "all averaging (\`--merge keep\`)" "$(figures "--merge keep" "")" "$all"
row "unmixing (\`--silhouettes whole\`)" "$(figures "--silhouettes whole" "")" "$all"
row "the test of photo-consistency (\`--agreement assume\`)" "$(figures "--agreement assume" "")" "$all"
row "the depth of images (\`--optical off\`)" "$(figures "--optical off" "")" "$all"
row "visibility at every lens point (\`--method selective\`)" "$(figures "" "--method selective")" "$all"
copy_source
while IFS='|' read -r label file what instead; do
    row "$label (\`$file\`)" "$(variant "$file" "$what" "$instead" figures "" "")" "$all"
done < <(grep -v '^#' "$(dirname "$0")/techniques.txt")
