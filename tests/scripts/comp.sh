# Checks what docs/comp.md claims about the pictures of its commands; readme.sh runs the commands and then this, in
# their folder.
#   bash comp.sh BIN_DIR
set -euo pipefail
bin=$1
page=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)/docs/comp.md
fail() {
    echo "FAIL: docs/comp.md: $*" >&2
    exit 1
}
decibels() { "$bin/dof-compare" "$1" "$2" | awk '$1 == "psnr_tonemapped" { print $2 }'; }
holds() { awk "BEGIN { exit !($1) }" || fail "not so: $2: $1"; }

# Each row of the table | `picture` | `truth` | dB |: at most a quarter of a dB lower. A picture shown as a warning may
# not be better than stated either.
declare -A db
while read -r picture truth stated; do
    db[$picture]=$(decibels "$picture" "$truth")
    holds "${db[$picture]} >= $stated - 0.25 && ${db[$picture]} <= $stated + 1.5" "$picture has the $stated dB of the page"
done < <(sed -nE 's/^\| .* \| `([^`]+)` \| `([^`]+)` \| ([0-9.]+) \|$/\1 \2 \3/p' "$page")
[ "${#db[@]}" -ge 14 ] || fail "the table has ${#db[@]} rows"

# Held out by each other, both equal the shot in one render, which a plain over does not; so do one of them over the
# other, a photograph with a matte, and both merged.
holds "${db[together.exr]} >= ${db[whole.exr]} - 0.1" "the two held out by each other sum to the whole"
for right in together merged held-over-plate; do holds "${db[$right.exr]} >= ${db[over.exr]} + 5" "$right is right where over is wrong"; done
holds "${db[in-photograph.exr]} >= ${db[before-the-photograph.exr]} + 5" "the matte holds the CG out"
# Where the element is in front of everything, over is correct.
for picture in over whole both/reference; do "$bin/sparselens-pictures" edit $picture.exr left.${picture##*/}.exr channels=R,G,B,A crop=40x90; done
holds "$(decibels left.over.exr left.reference.exr) >= $(decibels left.whole.exr left.reference.exr) - 0.5" "over is right on the left"

# A frame of a range equals that frame's picture alone.
cmp pull.0002.exr frame-2.exr || fail "a frame of the pull is another alone"
# The matte equals the alpha of the held-out element, computed in two ways; gains are the same before and after.
"$bin/sparselens-pictures" edit matte-of-element.exr matte.rgb.exr channels=R=element.Y,G=element.Y,B=element.Y
"$bin/sparselens-pictures" edit element-held.exr alpha.rgb.exr channels=R=A,G=A,B=A
holds "$(decibels matte.rgb.exr alpha.rgb.exr) >= 40" "the matte is the held-out alpha"
holds "$(decibels gained-before.exr gained-after.exr) >= 60" "gains before and after are the same"
holds "${db[clamped-after.exr]} >= ${db[clamped-before.exr]} + 2" "clamps belong after"
# The advice on what to render.
holds "${db[mist-views.exr]} >= ${db[mist-deep.exr]} - 0.5" "five views suffice for a thin mist"
holds "${db[hair.exr]} >= ${db[hair-alone.exr]} + 0.5" "five views are better for hair"
holds "${db[glass.exr]} >= ${db[glass-alone.exr]} + 6" "five views are better for glass"
