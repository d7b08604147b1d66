# The worth of each technique: each is switched off by itself, with an option or a change of one line of code. The
# tables show how the picture changes (dB of the whole, and of its worst blocks) and what the tools then cost (user CPU
# seconds; runs with and without it alternate, and the least of three counts). They have: whole pictures at final
# quality from five views; inputs that some techniques were made for; seconds; views of once and four times the size of
# a picture of 320x180. An hour on two cores, half of it for building and tracing; with --keep, what a run that was
# ended has measured is not measured again. Needs openimageio-tools and the views of ../shared.
. "$(dirname "$0")/common.inc" "$1"
. "$(dirname "$0")/variants.inc"
traced=(fence grass mirror) rendered=(yard pelt street macro pinecone porch)
whole=(fence grass mirror yard pelt street macro pinecone)
parts=(macro:inside pinecone:inside street:border porch:border macro-alone:inside pinecone-alone:inside wide lamps fence:A)
timed=(fence mirror street pinecone wide)
sizes=()
for scene in "${traced[@]}"; do sizes+=("$scene.1x" "$scene.4x"); done
columns=("${whole[@]}" "${parts[@]}" "${sizes[@]}")

# input NAME FOLDER REFERENCE: views, and the picture that they are compared with.
input() {
    ln -sfn "$2" "$1"
    ln -sfn "$3" "$1.exr"
    five_views "$1" >"$1.words"
}
# keep PART NAME MASK...: a reference with NaN, which dof-compare leaves out, where the mask that oiiotool makes is 0.
keep() { oiiotool "${@:3}" --ch 0,0,0 --subc 1 --powc .5 "$2.exr" --ch R,G,B --add --chnames R,G,B -o "$2:$1.exr"; }

for scene in "${traced[@]}"; do
    trace $scene.truth "$scene" --size 640x360 --views 0 --reference 2048
    trace $scene.views "$scene" --size 640x360
    input $scene $scene.views $scene.truth/reference.exr
    trace $scene.small "$scene" --size 320x180 --views 0 --reference 2048
    for n in 1 4; do
        trace $scene.${n}x.views "$scene" --size 320x180 --spp 16 --supersample $n
        input $scene.${n}x $scene.${n}x.views $scene.small/reference.exr
    done
done
trace wide.views fence --size 640x360 --lens-radius .15 --focus-distance .5 --reference 1024
input wide wide.views wide.views/reference.exr
trace lamps.views lamps --size 160x90 --reference 16384
input lamps lamps.views lamps.views/reference.exr
for scene in "${rendered[@]}"; do input $scene "$shared/views/$scene" "$shared/views/$scene/reference.exr"; done
for scene in macro pinecone; do
    input $scene-alone "$shared/views/$scene" "$shared/views/$scene/reference.exr"
    keep inside $scene "$shared/views/$scene/mask.exr"
    ln -sfn $scene:inside.exr $scene-alone:inside.exr
done
for scene in street porch; do # pictures of 480x270
    keep border $scene --pattern constant:color=1 480x270 1 --fill:color=0 448x238+16+16
done
ln -sfn fence.exr fence:A.exr

# picture BIN INPUT WARP_OPTIONS GATHER_OPTIONS: picture.exr, with user CPU seconds in warp.s and gather.s. If $warps is
# not set, it takes the LDI that was made with everything on; if it is "only" and the LDI is the same, the picture too.
picture() {
    local TIMEFORMAT=%U words from quality="--quality final"
    # Final quality would take most of an hour for macro and pinecone; other methods have none.
    [[ $4 != --method* && $2 != *.?x && $2 != macro* && $2 != pinecone* ]] || quality=
    read -ra words <"$2.words"
    from=("$2.ldi.exr")
    : >log
    echo 0 >warp.s
    if [[ $2 == *-alone ]]; then
        from=("${words[@]:0:9}") # the lens and the centre view
    elif [ -n "$warps" ]; then
        # shellcheck disable=SC2086
        { time "$1/ldi-warp" $3 "${words[@]}" -o - >warped.exr 2>>log; } 2>warp.s || { cat log >&2 && return 1; }
        from=(warped.exr)
        if [ "$warps" = only ] && cmp -s warped.exr "$2.ldi.exr"; then cp "$2.exr.kept" picture.exr && return; fi
    fi
    # shellcheck disable=SC2086
    { time "$1/dof-gather" "${from[@]}" $quality $4 -o picture.exr 2>>log; } 2>gather.s || { cat log >&2 && return 1; }
}
# figures BIN WARP_OPTIONS GATHER_OPTIONS: one line for each column: dB and dB of the worst blocks; A's largest error.
figures() {
    local column
    rm -f made.*.exr
    for column in "${columns[@]}"; do
        local of=${column%%:*}
        [ -e "made.$of.exr" ] || { picture "$1" "$of" "$2" "$3" && mv picture.exr "made.$of.exr"; } || return 1
        dof-compare "made.$of.exr" "$column.exr" | awk -v alpha="${column#*:}" '{ of[$1] = $2 }
            END { print alpha == "A" ? of["max_alpha"] : of["psnr_tonemapped"] " " of["psnr_worst"] }'
    done
}
# costs BIN WARP_OPTIONS GATHER_OPTIONS: for each timed input: seconds of warp and gather with everything on, and so.
costs() {
    local of round
    for of in "${timed[@]}"; do
        for round in 1 2 3; do
            picture base "$of" "" "" && paste -d ' ' warp.s gather.s | tr '\n' ' '
            picture "$1" "$of" "$2" "$3" && paste -d ' ' warp.s gather.s
        done | awk '{ for (i = 1; i <= 4; ++i) if (NR == 1 || $i < least[i]) least[i] = $i }
            END { print least[1], least[2], least[3], least[4] }'
    done
}

# cells LABEL FIGURES ALL: a row of a table: the changes from ALL, or the figures themselves.
cells() {
    paste -d ' ' <(echo "$2") <(echo "${3-}") | awk -v label="$1" 'BEGIN { printf "| %s |", label }
        NF == 4 { printf " %+.2f / %+.1f |", $1 - $3, $2 - $4 } NF == 2 && $0 !~ / $/ { printf " %+.3f |", $1 - $2 }
        NF == 2 && / $/ { printf " %.2f / %.1f |", $1, $2 } NF == 1 { printf " %.3f |", $1 } END { print "" }'
}
# changes LABEL COSTS: a row of the table of seconds, in per cent.
changes() {
    awk -v label="$1" 'function change(so, all) {
            if (all == 0) return "0"
            all = 100 * (so - all) / all
            return all > -3 && all < 3 ? "0" : sprintf("%+.0f", all) }
        BEGIN { printf "| %s |", label } { printf " %s / %s |", change($3, $1), change($4, $2) } END { print "" }' <<<"$2"
}
# split FIRST COUNT FIGURES
split() { tail -n "+$1" <<<"$3" | head -n "$2"; }
# row LABEL FIGURES ALL: a row of each table of figures; all but the first are kept for later.
row() {
    local w=${#whole[@]} p=${#parts[@]} s=${#sizes[@]}
    cells "$1" "$(split 1 $w "$2")" "$(split 1 $w "${3-}")"
    cells "$1" "$(split $((w + 1)) $p "$2")" "$(split $((w + 1)) $p "${3-}")" >>parts.md
    cells "$1" "$(split $((w + p + 1)) $s "$2")" "$(split $((w + p + 1)) $s "${3-}")" >>sizes.md
}
head_of() { # COLUMN...
    printf '| |%s\n' "$(printf ' %s |' "$@")"
    printf '|---|%s\n' "$(printf -- '---|%.0s' "$@")"
}
# measure BIN WARP_OPTIONS GATHER_OPTIONS
measure() { figures "$@" >new.figures && costs "$@" >new.costs; }
measure_all() { # also keeps the pictures
    figures base "" "" >new.figures || return 1
    for picture in made.*.exr; do mv "$picture" "${picture#made.}.kept"; done
    costs base "" "" >new.costs
}
# measured LABEL COMMAND...: $kept.figures and $kept.costs, which the command measures unless they are there.
measured() {
    kept=$said/$(sha256sum <<<"$1" | cut -c 1-16)
    [ -e "$kept.costs" ] || { "${@:2}" && mv new.figures "$kept.figures" && mv new.costs "$kept.costs"; }
}
without() { # LABEL COMMAND...
    measured "$@" || return 1
    row "$1" "$(cat "$kept.figures")" "$all"
    changes "$1" "$(cat "$kept.costs")" >>seconds.md
}

said=said.$(git -C "$project" rev-parse --short=10 HEAD:src)
mkdir -p "$said"
copy_source
rm -rf base
cp -r source/build/bin base
for of in "${columns[@]%%:*}" "${timed[@]}"; do
    # shellcheck disable=SC2046
    [[ $of == *-alone ]] || base/ldi-warp $(cat "$of.words") -o - >"$of.ldi.exr" 2>log || { cat log >&2 && exit 1; }
done
head_of "${whole[@]}"
head_of "${parts[@]/:/, }" >parts.md
head_of "${sizes[@]}" >sizes.md
head_of "${timed[@]}" >seconds.md
warps=yes
measured "everything on" measure_all
all=$(cat "$kept.figures")
row "everything on" "$all"
awk 'BEGIN { printf "| everything on, seconds |" } { printf " %.2f / %.2f |", $1, $2 } END { print "" }' "$kept.costs" >>seconds.md
without "all averaging (\`--merge keep\`)" measure base "--merge keep" ""
without "unmixing (\`--silhouettes whole\`)" measure base "--silhouettes whole" ""
without "the test of photo-consistency (\`--agreement assume\`)" measure base "--agreement assume" ""
without "the depth of images (\`--optical off\`)" measure base "--optical off" ""
warps=
without "visibility at every lens point (\`--method selective\`)" measure base "" "--method selective"
while IFS='|' read -r label file what instead; do
    case $file in src/dof/*) warps= ;; src/warp/*) warps=only ;; *) warps=yes ;; esac
    without "$label" variant "$file" "$what" "$instead" measure source/build/bin "" ""
done < <(grep -v '^#' "$(dirname "$0")/techniques.txt")
printf '\nInputs that some techniques were made for:\n\n'
cat parts.md
printf '\nUser CPU seconds of `ldi-warp` / `dof-gather`, and their changes in per cent (0: less than 3):\n\n'
cat seconds.md
printf '\nOf 320x180 at normal quality, with the same rays in views of once and four times the size:\n\n'
cat sizes.md
