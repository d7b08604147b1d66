# The worth of each technique: each is switched off by itself, with an option or a change of one line of code, and the
# table shows how many dB the picture then gains (at final quality, from five views of 16 samples). Then the same at
# normal quality with views of the same rays at once, twice and four times the size of a picture of 320x180: a step that
# brings less than 0.05 dB at a size is not needed there. An hour, most of it for building.
. "$(dirname "$0")/common.inc" "$1"
. "$(dirname "$0")/variants.inc"
built_in=(fence grass mirror)
scenes=("${built_in[@]}")
for scene in "${built_in[@]}"; do
    trace $scene.truth "$scene" --size 640x360 --views 0 --reference 2048
    trace $scene "$scene" --size 640x360
    ln -sfn $scene.truth/reference.exr $scene.exr
    trace $scene.small "$scene" --size 320x180 --views 0 --reference 2048
    for n in 1 2 4; do
        trace $scene.${n}x "$scene" --size 320x180 --spp 16 --supersample $n
        ln -sfn $scene.small/reference.exr $scene.${n}x.exr
    done
done
fine=()
for scene in "${built_in[@]}"; do fine+=($scene.1x $scene.2x $scene.4x); done
for scene in yard pelt; do
    [ -e "$shared/views/$scene" ] || continue
    ln -sfn "$shared/views/$scene" $scene
    ln -sfn "$shared/views/$scene/reference.exr" $scene.exr
    scenes+=($scene)
done

figures() { # WARP_OPTIONS GATHER_OPTIONS: one line for each scene, also the fine ones
    local scene quality
    for scene in "${scenes[@]}" "${fine[@]}"; do
        quality="--quality final"
        [[ $2 != --method* && $scene != *.?x ]] || quality= # other methods have none
        # shellcheck disable=SC2046,SC2086
        ldi-warp $1 $(five_views "$scene") -o - 2>log | dof-gather - $quality $2 -o picture.exr 2>>log ||
            { cat log >&2 && return 1; }
        db picture.exr "$scene.exr" || return 1
        echo
    done
}
cells() { # LABEL FIGURES ALL
    paste <(echo "$2") <(echo "${3-}") | awk -v label="$1" 'BEGIN { printf "| %s |", label }
        NF == 2 { printf " %+.2f |", $1 - $2 } NF == 1 { printf " %.2f |", $1 } END { print "" }'
}
# row LABEL FIGURES ALL: prints a row of the first table, and keeps a row of the second for later.
row() {
    local count=${#scenes[@]}
    cells "$1" "$(head -n "$count" <<<"$2")" "$(head -n "$count" <<<"${3-}")"
    cells "$1" "$(tail -n "+$((count + 1))" <<<"$2")" "$(tail -n "+$((count + 1))" <<<"${3-}")" >>fine.md
}
head_of() { # SCENE...
    printf '| |%s\n' "$(printf ' %s |' "$@")"
    printf '|---|%s\n' "$(printf -- '---|%.0s' "$@")"
}
head_of "${scenes[@]}"
head_of "${fine[@]}" >fine.md
all=$(figures "" "")
row "everything on, dB" "$all"
without() { # LABEL COMMAND...
    local now
    now=$("${@:2}")
    row "$1" "$now" "$all"
}
without "all averaging (\`--merge keep\`)" figures "--merge keep" ""
without "unmixing (\`--silhouettes whole\`)" figures "--silhouettes whole" ""
without "the test of photo-consistency (\`--agreement assume\`)" figures "--agreement assume" ""
without "the depth of images (\`--optical off\`)" figures "--optical off" ""
without "visibility at every lens point (\`--method selective\`)" figures "" "--method selective"
copy_source
while IFS='|' read -r label file what instead; do
    without "$label (\`$file\`)" variant "$file" "$what" "$instead" figures "" ""
done < <(grep -v '^#' "$(dirname "$0")/techniques.txt")
printf '\nOf 320x180 at normal quality, with the same rays in views of once, twice and four times the size:\n\n'
cat fine.md
