#!/bin/bash
# --stats of every stage: one line of JSON per stage and frame, with correct numbers.
. "$(dirname "$0")/check.sh"
. "$source_dir/tests/tools/deep.sh"
command -v python3 >/dev/null || skip "needs python3 to read JSON"

# holds FILE LINE EXPRESSION...: each expression is true in Python, where s is that line (from 0).
holds() {
    local file=$1 line=$2
    shift 2
    for expression in "$@"; do
        [ "$(python3 -c "import json, sys; s = json.loads(open(sys.argv[1]).readlines()[int(sys.argv[2])]); print($expression)" "$file" "$line")" = True ] ||
            fail "not so: $expression: $(sed -n "$((line + 1))p" "$file")"
    done
}

# The stages of a pipe share a file; lines are appended.
exits 0 "$bin/ldi-warp" views/center.exr "${rim[@]}" -o ldi.exr --stats stats.json
exits 0 "$bin/ldi-cluster" ldi.exr -o clustered.exr --tolerance 2 --stats stats.json
exits 0 "$bin/dof-gather" clustered.exr -o out.exr --stats stats.json
[ "$(wc -l <stats.json)" -eq 3 ] || fail "not a line a stage: $(cat stats.json)"
pixels=$((96 * 54))
holds stats.json 0 's["tool"] == "ldi-warp"' 's["views"] == 5' "s['pixels_given'] == 5 * $pixels" 's["pixels_not_given"] == 0' \
    's["samples"] + s["samples_merged"] == s["pixels_given"]' 's["samples_merged"] > 0' '"frame" not in s' \
    'set(s["ms"]) == {"read and warp", "warp", "write"}' 's["ms"]["read and warp"] >= s["ms"]["warp"] > 0'
holds stats.json 1 's["tool"] == "ldi-cluster"' 's["samples_read"] - s["samples"] == s["samples_merged"] > 0' 's["samples_invisible"] == 0' \
    '0 < s["largest_coc_change"] <= 2'
holds stats.json 2 's["tool"] == "dof-gather"' 's["input_read"]' 's["tiles"] == 2' 's["channels_left_out"] == []' \
    'sum(s["lens_points"].values()) + s["tiles_copied"] == s["tiles"]' \
    'set(s["ms"]) == {"read", "picture", "gather", "write"}' 's["ms"]["picture"] >= s["ms"]["gather"] > 0'

# --stats changes no picture, and - is standard error.
exits 0 "$bin/dof-gather" clustered.exr -o same.exr --stats -
same same.exr out.exr "--stats"
mv stderr by_stderr.json
holds by_stderr.json 0 's["tool"] == "dof-gather"'
exits 0 "$bin/dof-gather" clustered.exr -o - --stats -
mv stdout same.exr
mv stderr by_stderr.json
same_pixels same.exr out.exr "--stats - beside -o -"
holds by_stderr.json 0 's["tool"] == "dof-gather"'
exits 0 "$bin/dof-gather" clustered.exr -o same.exr
[ ! -s stderr ] || fail "stats without being asked: $(cat stderr)"

# Cropped, masked and empty views give fewer pixels.
picture edit views/view_0.exr half.exr crop=48x54
picture edit views/view_1.exr masked.exr R=0 G=0 B=0 A=0
exits 0 "$bin/ldi-warp" views/center.exr half.exr masked.exr -o x.exr --stats partial.json
holds partial.json 0 's["views"] == 3' 's["views_empty"] == 1' "s['pixels_given'] == 1.5 * $pixels" "s['pixels_not_given'] == 1.5 * $pixels"

# A frame range: one line per frame; a focus pull reads its LDI once.
exits 0 "$bin/dof-gather" ldi.exr -o pull.#.exr --frames 3-5 --focus-distance 3:2,5:8 --lens-samples 24 --channels R,A --stats frames.json
[ "$(wc -l <frames.json)" -eq 3 ] || fail "not a line a frame: $(cat frames.json)"
holds frames.json 0 's["frame"] == 3' 's["input_read"]'
holds frames.json 2 's["frame"] == 5' 'not s["input_read"]' 'set(s["lens_points"]) <= {"24"}'
picture edit views/center.exr more.exr channels=R,G,B,A,Z,more.R=R
exits 0 "$bin/dof-gather" more.exr -o x.exr --channels rgba --stats more.json
holds more.json 0 's["channels_left_out"] == ["more.R"]'

# Tiles in focus are copied: with a plane in focus, and with a lens of radius 0.
exits 0 "$bin/dof-trace" slant --size 192x128 --views 0 --spp 1 -o slant
exits 0 "$bin/dof-gather" slant/center.exr -o x.exr --fstop 100 --stats focus.json
holds focus.json 0 's["tiles"] == 6' 's["tiles_copied"] == 6' 's["lens_points"] == {}'
exits 0 "$bin/dof-gather" slant/center.exr -o x.exr --lens-radius 0 --stats pinhole.json
holds pinhole.json 0 's["tiles"] == 0'

# The plan: the pixels that it asks for and the others.
exits 0 "$bin/ldi-plan" views/center.exr -o plan.json --noise 0 --views 3 --stats plan_stats.json
holds plan_stats.json 0 's["tool"] == "ldi-plan"' 's["views"] + s["views_left_out"] == 3' "s['pixels'] + s['pixels_left_out'] == 3 * $pixels" 's["pixels_left_out"] > 0'

fails_saying 1 'no/such: cannot write' "$bin/dof-gather" clustered.exr -o x.exr --stats no/such
