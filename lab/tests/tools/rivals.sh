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

# lab/denoise, which lab/rivals runs: denoising gains with few rays, changes only colours, and takes time; dof-report
# measures the result.
for row in 'denoised ray tracing,,5 rays' 'denoised ray tracing,,320 rays' 'centre + 4 denoised,lens normal,1 sample' 'centre + 4 denoised,lens normal,64 samples'; do
    grep -qF "fence,$row," all/report/report.csv || fail "report.csv has no $row: $(cut -d , -f 1-4 all/report/report.csv)"
done
cd all/fence
db() { sed -nE "s/^$1: ([0-9.]+) dB.*/\1/p" denoise.said; }
awk -v a="$(db drt_5.denoised.exr)" -v b="$(db drt_5.exr)" 'BEGIN { exit !(a > b + 2 && b > 10) }' || fail "five rays gain nothing: $(cat denoise.said)"
for file in view_1 4/center; do
    picture same $file.exr $file.denoised.exr A,Z >/dev/null || fail "$file has another depth"
    picture differ $file.exr $file.denoised.exr R,G,B >/dev/null || fail "$file was not denoised"
    for kind in exr denoised.exr; do exrheader $file.$kind | grep -E '^(focus|worldToCamera|sparselens:)' -A 4 >$kind.txt; done
    [ -s exr.txt ] || fail "$file has no camera"
    cmp exr.txt denoised.exr.txt || fail "$file has another camera"
done
python3 - <<'PYTHON' || fail "the denoiser takes no time"
import json
for folder in ".", "1", "4", "64":
    seconds = json.load(open(f"{folder}/camera.json"))["seconds"]
    assert seconds["view_0.denoised.exr"] > seconds["view_0.exr"]
PYTHON
