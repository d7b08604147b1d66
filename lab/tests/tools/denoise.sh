#!/bin/bash
# lab/denoise with Open Image Denoise (PyPI): denoising gains with few rays, changes only colours, and dof-report
# measures the result.
. "$(dirname "$0")/../../../tests/tools/check.sh"
python3 -c 'import ensurepip' 2>/dev/null || skip "needs python3-venv"
code=0
"$source_dir/lab/denoise" "$bin" fence views 96x54 64 area >said 2>stderr || code=$?
[ $code -ne 77 ] || skip "Open Image Denoise: PyPI cannot be reached, or has no wheel for this Python"
[ $code -eq 0 ] || fail "lab/denoise: exit $code ($(tail -n 3 stderr))"

db() { sed -nE "s/^$1: ([0-9.]+) dB.*/\1/p" said; }
awk -v a="$(db drt_5.denoised.exr)" -v b="$(db drt_5.exr)" 'BEGIN { exit !(a > b + 2 && b > 10) }' || fail "five rays gain nothing: $(cat said)"
for file in view_1 4/center; do
    picture same views/$file.exr views/$file.denoised.exr A,Z >/dev/null || fail "$file has another depth"
    picture differ views/$file.exr views/$file.denoised.exr R,G,B >/dev/null || fail "$file was not denoised"
    for kind in exr denoised.exr; do exrheader views/$file.$kind | grep -E '^(focus|worldToCamera|sparselens:)' -A 4 >$kind.txt; done
    cmp exr.txt denoised.exr.txt || fail "$file has another camera"
done
exits 0 "$bin/dof-report" --quick views -o report
for row in 'denoised ray tracing,,5 rays' 'denoised ray tracing,,320 rays' 'centre + 4 denoised,lens normal,1 sample' 'centre + 4 denoised,lens normal,64 samples'; do
    grep -qF "views,$row," report/report.csv || fail "report.csv has no $row: $(cut -d , -f 1-4 report/report.csv)"
done
python3 - <<'PYTHON' || fail "the denoiser takes no time"
import json
for folder in ".", "1", "4", "64":
    seconds = json.load(open(f"views/{folder}/camera.json"))["seconds"]
    assert seconds["view_0.denoised.exr"] > seconds["view_0.exr"]
PYTHON
