#!/bin/bash
# lab/mitsuba with Mitsuba 3 (PyPI): five views by another renderer approximate the picture of its own lens, and more
# rays come nearer.
. "$(dirname "$0")/../../../tests/tools/check.sh"
python3 -c 'import ensurepip' 2>/dev/null || skip "needs python3-venv"
code=0
"$source_dir/lab/mitsuba" "$bin" views 48x27 64 >said 2>stderr || code=$?
[ $code -ne 77 ] || skip "Mitsuba: PyPI cannot be reached, or has no wheel for this Python"
[ $code -eq 0 ] || fail "lab/mitsuba: exit $code ($(tail -n 3 stderr))"

db() { sed -nE "s/^$1: ([0-9.]+) dB.*/\1/p" said; }
rises() { awk -v a="$1" -v b="$2" -v by="$4" 'BEGIN { exit !(a > 5 && b > a + by) }' || fail "$3: $1, then $2 dB: $(cat said)"; }
rises "$(db drt_5.exr)" "$(db drt_320.exr)" 'more rays' 3
rises "$(db drt_5.exr)" "$(db drt_5.denoised.exr)" 'a denoiser' 2
rises "$(db drt_20.exr)" "$(db 'five views of 64, exr')" 'five views' 1
