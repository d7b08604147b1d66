# A system that allows no threads, no large files, or no writing to an output. The tool makes the picture, or prints one
# line and exits with 1. It leaves no unfinished file, and does not replace a read-only one.
#   bash limits.sh BIN_DIR
. "$(dirname "$0")/check.sh"

oiiotool --pattern fill:topleft=0.1,0.5,0.9,1:bottomright=1,0.25,0.5,1 64x48 4 --chnames R,G,B,A -d float -o rgba.exr
oiiotool --pattern constant:color=2 64x48 1 --chnames Z -d float -o z.exr
oiiotool rgba.exr z.exr --chappend -d float -o in.exr
lens=(--focal-length 50 --sensor-width 36 --lens-radius .2 --focus-distance 6)
exits 0 "$bin/dof-gather" in.exr -o expected.exr "${lens[@]}"

# Root may do everything, and counts as having no limit of processes: another user runs the tools then.
chmod 755 "$scratch" && mkdir -m 777 other && cp in.exr other
as_other() {
    if [ "$(id -u)" -eq 0 ]; then setpriv --reuid=54321 --regid=54321 --clear-groups "$@"; else "$@"; fi
}
as_other test -x "$bin/dof-gather" || skip "the tools in $bin cannot be run by another user"

for threads in 0 1; do
    as_other bash -c 'ulimit -u 1; exec "$@"' - "$bin/dof-gather" in.exr -o other/out.exr "${lens[@]}" --threads $threads 2>stderr ||
        [ "$(id -u)" -ne 0 ] || fail "no thread can be started: $(cat stderr)" # other processes of this user count, too
    [ ! -e other/out.exr ] || picture same other/out.exr expected.exr || fail "without threads"
    rm -f other/out.exr
done

exits 1 bash -c 'ulimit -f 8; exec "$@"' - "$bin/dof-gather" in.exr -o other/large.exr "${lens[@]}" --compression none
grep -q 'large.exr: cannot write: File too large' stderr || fail "a file that grows too large: $(cat stderr)"
[ "$(ls -A other)" = in.exr ] || fail "left behind: $(ls -A other)"

as_other bash -c 'echo published >other/ro.exr && chmod 444 other/ro.exr'
code=0
as_other "$bin/dof-gather" in.exr -o other/ro.exr "${lens[@]}" 2>stderr || code=$?
[ $code -eq 1 ] && grep -q 'ro.exr: cannot replace: Permission denied' stderr || fail "a read-only output: exit $code, $(cat stderr)"
[ "$(cat other/ro.exr)" = published ] || fail "a read-only output was replaced"
