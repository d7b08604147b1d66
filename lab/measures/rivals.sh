# Ray tracing, denoised ray tracing, averages, five views, other programs, notes, focus pulls: lab/rivals on eight
# scenes and one of Mitsuba, 320x180. 40 CPU minutes from nothing; needs PyPI, and crates.io for OpenDefocus. With
# --keep FOLDER only the parts that take seconds are measured again.
. "$(dirname "$0")/common.inc" "$1"
"$(dirname "$0")/../rivals" --bin "$bin" . >&2
cat table.md
echo
cat notes.md
