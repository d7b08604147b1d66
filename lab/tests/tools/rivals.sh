#!/bin/bash
# lab/rivals on one small scene: rows at equal rays for each way, focus pulls for each way, the cost of a note, and what
# is left out.
. "$(dirname "$0")/../../../tests/tools/check.sh"
python3 -c 'import ensurepip' 2>/dev/null || skip "needs python3-venv"
exits 0 "$source_dir/lab/rivals" --bin "$bin" --scenes 'fence meadow' --size 96x54 --reference 128 --without 'opendefocus blender' all
grep -q 'left out: meadow' stderr || fail "a scene that is not there is not told: $(cat stderr)"
grep -q '^- left out: OpenDefocus, as asked' all/table.md || fail "what is left out is not in the table: $(cat all/table.md)"
if grep -q 'left out: Open Image Denoise' all/left-out; then
    grep -q fence all/report.txt || fail "nothing is measured without PyPI"
    skip "Open Image Denoise: PyPI cannot be reached, or has no wheel for this Python"
fi
# Each way has a cell, except finer views at 5 rays, finished pictures at 5 and 20, half of the rays in views at 5 and 80, where
# that is the division of finished pictures, and averages at 1280.
awk -F '|' '/^\| fence, / { split($2, name, " ")
    empty = name[2] == 5 ? " 8 9 10 11 12 " : name[2] == 20 ? " 10 11 " : name[2] == 80 ? " 12 " : name[2] == 1280 ? " 5 " : ""
    for (i = 3; i <= 12; ++i) if (($i ~ /[0-9], [0-9]/) == (index(empty, " " i " ") > 0)) exit 1
    ++rows } END { exit rows != 5 }' all/table.md || fail "a cell is missing: $(cat all/table.md)"
for way in 'distributed ray tracing, 80 rays' 'denoised ray tracing, 80 rays' 'accumulated lens views, 80 rays' 'centre + 4, lens normal, 256 samples' \
    'views and rays, finished, 80 rays'; do
    grep -qF "| fence | $way | " all/table.md || fail "no pull of $way: $(cat all/table.md)"
done
[ "$(grep -cE '^\| (focus|two stops|six blades|matte).* s, 0 rays \|$' all/notes.md)" -eq 4 ] || fail "not four notes: $(cat all/notes.md)"
grep -q 'Denoised ray tracing, of as many rays?' all/report/index.html || fail 'the page does not answer about the denoiser'
stamp=$(stat -c %Y all/fence/denoise.said)
exits 0 "$source_dir/lab/rivals" --bin "$bin" --scenes fence --size 96x54 --reference 128 --without 'opendefocus blender' all
[ "$(stat -c %Y all/fence/denoise.said)" = "$stamp" ] || fail 'what is there is made again'
