# tools/demo.sh with existing executables, on a small picture: writes what it promises, and reuses earlier tracing
# unless the arguments or the files have changed.
#   bash demo.sh BIN_DIR
. "$(dirname "$0")/../tools/check.sh"

demo() { exits 0 "$source_dir/tools/demo.sh" --bin "$bin" --size 96x54 --spp 4 --reference 32 -o "$scratch/out" "$@"; }
reused() { grep -c 'earlier run' stdout || true; }

demo
[ "$(reused)" -eq 0 ] || fail "the first run claims an earlier one: $(cat stdout)"
[ ! -s stderr ] || fail "talks on stderr: $(cat stderr)"
grep -Eq '^ldi-warp +[0-9]+\.[0-9]+$' stdout || fail "no time of ldi-warp: $(cat stdout)"
grep -Eq '^import sparselens.* ([0-9]+\.[0-9]+|left out: .*)$' stdout || fail "no line of Python: $(cat stdout)"
decibels() { sed -nE "s/^ *$1.* ([0-9]+\.[0-9]+) +[01]\.[0-9]{4}\$/\1/p" stdout; }
before=$(decibels 'the centre view as it is') after=$(decibels 'dof-gather --method lens')
[ -n "$before" ] && [ -n "$after" ] || fail "no error figures: $(cat stdout)"
# At most half the error of the view, although the reference, of few rays, is noisy too: 6 dB.
awk "BEGIN { exit !($after >= $before + 6) }" || fail "defocusing brings too little: $before dB before, $after dB after"
! grep -q 'without titles' stdout || fail "oiiotool finds no font: $(cat stdout)"
# It ends with what to look at: the pictures that it names exist, and the commands work.
sed '1,/^Look at/d' stdout >look
pictures=$(sed '/^The best one/,$d' look | grep -oE '[^ (]+\.(png|exr)')
[ "$(wc -l <<<"$pictures")" -ge 6 ] || fail "names too few pictures: $(cat stdout)"
for picture in $pictures; do
    [ -s "$picture" ] || fail "names $picture, which is not there"
done
grep -E '^  .*/dof-gather ' look >commands || fail "names no command: $(cat stdout)"
[ "$(wc -l <commands)" -eq 2 ] || fail "not two commands: $(cat commands)"
if [ -x "$bin/dof-view" ]; then
    view=$(sed -n '/^Or point at/{n;s/^ *//p}' look) # runs until it is stopped
    timeout 5 bash -c "exec $view" >said || [ $? -eq 124 ] || fail "$view: $(cat said)"
    grep -q '^http://127.0.0.1:[0-9]*/?key=' said || fail "$view: $(cat said)"
fi
cp out/lens.exr best.exr
rm out/lens.exr
exits 0 bash -e commands
picture same out/lens.exr best.exr || fail "the command makes another picture: $(cat commands)"
[ -s out/on-the-fence.png ] || fail "the second command makes no picture: $(cat commands)"
for picture in out/fence.png out/lens.png out/lens.exr out/selective.png out/ldi.exr out/views/center.png; do
    [ -s $picture ] || fail "no $picture"
done

demo
[ "$(reused)" -eq 2 ] || fail "tracing was not taken again: $(cat stdout)"
[ "$before" = "$(decibels 'the centre view as it is')" ] || fail "another error the second time: $(cat stdout)"
echo damaged >out/reference/reference.exr
demo --spp 1
[ "$(reused)" -eq 0 ] || fail "other arguments, or a damaged file, went unseen: $(cat stdout)"
exits 2 "$source_dir/tools/demo.sh" --nonsense 1
exits 2 "$source_dir/tools/demo.sh" --size

# If oiiotool finds no font by name or path, the pictures have no titles, and the demo says why.
mkdir no-fonts
cat >no-fonts/oiiotool <<END
#!/bin/bash
[[ " \$*" != *" --text"* ]] || { echo 'oiiotool ERROR: -text : Could not find font "DejaVuSans"' >&2; exit 1; }
exec $(command -v oiiotool) "\$@"
END
chmod +x no-fonts/oiiotool
PATH=$PWD/no-fonts:$PATH demo
grep -q 'fence.png .*; without titles, as oiiotool finds no font' stdout || fail "no word of titles: $(cat stdout)"
exits 0 oiiotool --info out/fence.png

# A build with the Python package but without its module, which the demo's own build gives if pybind11 is installed.
mkdir -p bare/python/sparselens
echo 'from ._sparselens import *' >bare/python/sparselens/__init__.py
ln -s "$(realpath "$bin")" bare/bin
bin=bare/bin demo
grep -q '^import sparselens.* left out: the module was not built' stdout || fail "no word of the module: $(cat stdout)"
