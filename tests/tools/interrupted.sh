#!/bin/bash
# Tools that are stopped, or cannot write: the old output is intact or the new one complete, and nothing else is left
# beside it except after SIGKILL, whose leftovers are recognised by their name (.NAME.PID-N.partial).
#
#   bash interrupted.sh BIN_DIR [KILLS]     KILLS: number of each signal, at random moments (5; 25 for a release)
. "$(dirname "$0")/check.sh"
. "$source_dir/tests/tools/deep.sh"
kills=${2:-5}
RANDOM=${SPARSELENS_SEED:-1}
lens=(--lens-radius 0.06)
exits 0 "$bin/dof-trace" fence --size 320x180 --spp 1 -o large
exits 0 "$bin/ldi-warp" large/center.exr large/view_?.exr -o ldi.exr
warp=("$bin/ldi-warp" large/center.exr large/view_?.exr)
gather=("$bin/dof-gather" ldi.exr)

# fresh: makes a folder out/ with an older picture in it.
fresh() {
    rm -rf out
    mkdir out
    echo old >out/x.exr
}
sound() { [ "$(head -c 3 out/x.exr)" = old ] || cmp -s out/x.exr "$1"; }

# The duration of the command in microseconds.
time_of() {
    local start=${EPOCHREALTIME/./}
    "$@" 2>/dev/null
    echo $((${EPOCHREALTIME/./} - start))
}

# killed SIGNAL EXPECTED COMMAND...: stops it at a random moment of its run; EXPECTED is its output if left alone.
old_left=0 new_there=0 partial_left=0
killed() {
    local signal=$1 expected=$2 process moment
    shift 2
    fresh
    "$@" -o out/x.exr 2>/dev/null &
    process=$!
    moment=$((RANDOM * span / 32768))
    sleep "$(printf '%d.%06d' $((moment / 1000000)) $((moment % 1000000)))"
    kill -s "$signal" $process 2>/dev/null || true
    wait $process 2>/dev/null || true
    sound "$expected" || fail "$signal leaves neither the old nor the new file: $* ($moment us)"
    if cmp -s out/x.exr "$expected"; then new_there=$((new_there + 1)); else old_left=$((old_left + 1)); fi
    for left in out/.[!.]* out/*; do
        case $left in
        out/x.exr | 'out/.[!.]*') ;;
        out/.x.exr.$process-*.partial)
            [ "$signal" = KILL ] || fail "$signal leaves $left"
            partial_left=$((partial_left + 1))
            ;;
        *) fail "$signal leaves $left" ;;
        esac
    done
}

fresh
exits 0 "${warp[@]}" -o warped.exr
exits 0 "${gather[@]}" -o gathered.exr
for signal in TERM KILL HUP; do
    span=$(($(time_of "${warp[@]}" -o x.exr) * 11 / 10))
    for ((i = 0; i < kills; ++i)); do killed $signal warped.exr "${warp[@]}"; done
    span=$(($(time_of "${gather[@]}" -o x.exr) * 11 / 10))
    for ((i = 0; i < kills; ++i)); do killed $signal gathered.exr "${gather[@]}"; done
done
echo "$((old_left + new_there)) kills: old file intact $old_left, new file complete $new_there; after SIGKILL $partial_left partial files"

# Failures to write: exit 1, one line that names the file, the old file untouched, nothing left behind.
untouched() {
    [ "$(cat out/x.exr)" = old ] || fail "the old file is gone: $1"
    [ "$(ls -A out)" = x.exr ] || fail "left behind: $(ls -A out): $1"
}
if [ "$(id -u)" -eq 0 ] && mkdir full && mount -t tmpfs -o size=64k tmpfs full 2>/dev/null; then
    trap 'umount "$scratch/full"; rm -rf "$scratch"' EXIT
    echo old >full/x.exr
    for tool in "${warp[*]}" "${gather[*]}"; do
        # shellcheck disable=SC2086
        fails_saying 1 'full/x.exr: .*No space left' $tool -o full/x.exr
        [ "$(cat full/x.exr)" = old ] && [ "$(ls -A full)" = x.exr ] || fail "a full disk: $(ls -lA full)"
    done
else
    echo "skipped: the full disk: no tmpfs can be mounted"
fi
fresh
chmod 555 out
if [ "$(id -u)" -ne 0 ]; then
    fails_saying 1 'out/x.exr: cannot (write|replace): Permission denied' "${gather[@]}" -o out/x.exr
elif command -v setpriv >/dev/null && chmod 755 "$scratch" && setpriv --reuid=65534 --clear-groups test -r ldi.exr -a -x "$bin/dof-gather"; then
    fails_saying 1 'out/x.exr: cannot (write|replace): Permission denied' setpriv --reuid=65534 --clear-groups "${gather[@]}" -o out/x.exr
else
    echo "skipped: the read-only folder: root writes everywhere"
fi
chmod 755 out
untouched "read-only folder"
fails_saying 1 'ldi.exr: cannot create the folder: Not a directory' "${gather[@]}" -o ldi.exr/x.exr
mkdir out.exr
fails_saying 1 'cannot write' "${gather[@]}" -o out.exr
rmdir out.exr
untouched "output is a folder"
fails_saying 1 'cannot write: No space left' "${gather[@]}" -o /dev/full
code=0
("${gather[@]}" -o - 2>pipe.txt || echo $? >code.txt) | head -c 10 >/dev/null
[ "$(cat code.txt 2>/dev/null)" = 1 ] && grep -q 'standard stream: cannot write: Broken pipe' pipe.txt ||
    fail "a reader that went away: $(cat code.txt pipe.txt)"

# An output that is a link to another file: the file is replaced, the link stays.
cp ldi.exr same.exr
ln -s same.exr link.exr
exits 0 "$bin/dof-gather" ldi.exr -o link.exr
cmp -s same.exr gathered.exr && [ -L link.exr ] || fail "output by a link"

# Any name works: nothing in it is executed, or taken for an option after --.
names=("with space.exr" "quote'\".exr" $'new\nline.exr' '-dash.exr' '$(touch run).exr' '`touch run`.exr' ';touch run;.exr'
    '*.exr' '%s%n.exr' $'\e[31m.exr' "$(printf 'x%.0s' {1..250}).exr")
for name in "${names[@]}"; do
    rm -rf named
    mkdir named
    cd named
    cp ../ldi.exr "./$name"
    exits 0 "$bin/dof-gather" -o "./out-${name:0:200}.exr" -- "$name"
    cmp -s "./out-${name:0:200}.exr" ../gathered.exr || fail "not the picture: $name"
    exits 0 "$bin/dof-gather" -o "./$name" -- ../ldi.exr # longest name: the temporary's must be cut
    exits 0 "$bin/ldi-cluster" "--tolerance=0.5" -o x.exr -- ../ldi.exr
    fails_saying 1 'missing' "$bin/dof-gather" -o x2.exr -- "missing$name"
    [ "$(find . -mindepth 1 -printf x | wc -c)" -eq 5 ] || fail "$name leaves $(ls -A)"
    cd ..
done
