# Each threshold of a stage is in its tuning.h, and the definition of a lamp in lens/lamp_spread.h, with its own name, and is
# used; rules that shaders share are in src/kernels. Other constants with a number as their value are listed here with a
# reason.
#   bash tuning.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

stages='plan warp dof finish match'

# FILE NAME...: sizes of stored or processed blocks, sentinels, bounds of arithmetic and its constants, defaults and
# tables of options.
allowed='
dof/facets/facets.h size
dof/facets/placed_facets.cpp at_once
dof/footprints/interpolation_blur.cpp cocs n offsets
dof/footprints/interpolation_blur.h largest_weight
dof/gather_rows.cpp beside most rows_at_once
dof/grain.cpp side
dof/border_reach.cpp rows_at_once
dof/lens/tile_plan.cpp blocks_in_run
dof/lens/highlights.h cell octaves
dof/lens/cell_rows.cpp half
dof/lens/cell_rows.h points_at_once
dof/lens/cells.cpp beside
dof/lens/cells.h cell_sizes
dof/lens/block_footprints.cpp in_area
dof/lens/block_footprints.h rounding
dof/lens/shadow_search.cpp rounding
dof/lens/shadow_search.cpp edge
dof/lens/shadow_search.h beside
dof/lens/fillers.cpp directions unknown
dof/lens/fillers.h nothing
dof/lens/tile_plan.h final_points largest_coc normal_points
dof/lens/lens_gather.h lens_tile_size
dof/lens/sample_blocks.h background size
dof/lens/tile_projection.cpp least_unit most
dof/lens/tile_projection.h lanes
dof/lens/tile_samples.cpp most_depth tested_from
dof/methods.cpp ids_at_once
dof/merge_layers.h layer_tolerance_px
dof/selective/splats.h sums_before_colours
dof/selective/selective.cpp at_once
dof/selective/splats.cpp square_size
dof/selective/splats.h too_little
plan/block_motion.cpp block_size
plan/disocclusion.h nothing
plan/noise.cpp block_size spread least_of_four
warp/images/matched_view.h cutout
warp/images/matched_view.h image_block reach
warp/images/patch_comparison.cpp alike
warp/images/patch_comparison.h patch_reach patch_row
warp/images/image_sweep.cpp band_rows
warp/images/image_sweep.cpp rounding rows
warp/images/image_depths.cpp band_rows
warp/lamps/lamp_light.cpp farthest_move
warp/reprojected_views.cpp far_off
warp/surfaces.cpp few
warp/warp.cpp rows_at_once
match/blocks.cpp first_tint nuisances
match/blocks.h most_changes
match/measure_lens.cpp coc_change ends_change first_motion
match/measure_lens.h quadratic_terms
match/smooth_keys.cpp second
finish/window_means.h run_length
finish/window_means.cpp bins
finish/finish_picture.cpp largest
finish/finish.cpp least_square
finish/finish.cpp columns most_channels rows
finish/cross_validation.cpp grain
finish/window_means.cpp lanes
'

faults=0
fault() {
    echo "FAIL: $1" >&2
    faults=1
}

# FILE NAME for each constant of these stages outside tuning.h whose value begins with a number.
constants() {
    find $(sed -E 's|([a-z]+)|src/\1|g' <<<"$stages") '(' -name '*.h' -o -name '*.cpp' ')' ! -name tuning.h | sort | xargs awk '
FNR == 1 { whole = "" }
{
    # A declaration in one line, without comments and without text in brackets.
    sub(/\/\/.*/, "")
    whole = whole " " $0
    if (whole ~ /[=,] *$/) next
    line = whole
    whole = ""
    if (line !~ /[^a-z_]const(expr)? (float|double|int|(std::)?u?int[0-9]+_t|std::size_t|unsigned|auto) [a-z_0-9]+ = / &&
        line !~ /[^a-z_]constexpr std::array/) next
    if (line ~ /[^a-z_]for \(/) next
    sub(/.*[^a-z_]const(expr)? (std::array(<[^>]*>)?|[a-z:_0-9]+) /, "", line)
    gsub(/\([^()]*\)/, "(x)", line)
    n = split(line, parts, /[,;]/)
    for (i = 1; i <= n; ++i) {
        part = parts[i]
        if (part !~ /^ *[a-z_0-9]+(\[[^]]*\])?( = |\{) *-?(0x|std::size_t\{)?[0-9.]+[a-z0-9.]*(-[0-9]+f?)?[^a-zA-Z_]*$/) continue
        sub(/^ */, "", part)
        match(part, /^[a-z_0-9]+/)
        print substr(FILENAME, 5), substr(part, 1, RLENGTH)
    }
}'
}
found=$(constants)
exempt=$(awk '{ for (i = 2; i <= NF; ++i) print $1, $i }' <<<"$allowed" | sort -u)
if left=$(sort -u <<<"$found" | comm -23 - <(echo "$exempt") | grep .); then fault "thresholds outside of tuning.h, or constants that this script does not name:
$left"; fi
if gone=$(sort -u <<<"$found" | comm -13 - <(echo "$exempt") | grep .); then fault "this script names constants that are not there:
$gone"; fi

# NAME and the struct's name, for all members.
members=$(for file in src/lens/lamp_spread.h $(sed -E 's|([a-z]+)|src/\1/tuning.h|g' <<<"$stages"); do
    struct=$(sed -nE 's/^struct ([A-Za-z]+Tuning) \{/\1/p' "$file")
    sed -nE "s/^ +static constexpr [a-z:_0-9<>, ]+ ([a-z_0-9]+)( = |\{).*/\1 $struct/p" "$file"
done)
[ "$(wc -l <<<"$members")" -ge 10 ] || fault "the members of tuning.h were not found"
if twice=$(cut -d ' ' -f 1 <<<"$members" | sort | uniq -d | grep .); then fault "several members of one name: $twice"; fi
used=$(grep -rohE '\b[A-Za-z]+Tuning::[a-z_0-9]+' src | sort -u)
while read -r name struct; do
    grep -qx "$struct::$name" <<<"$used" || fault "$struct::$name is not used"
done <<<"$members"
exit $faults
