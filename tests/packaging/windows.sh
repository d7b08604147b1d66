# The archive for Windows, by wine with a new prefix: the README's sixty seconds, names with spaces and letters beyond ASCII,
# long names, replaced files, binary pipes, a full disk, Ctrl-C, dof-view's answers, damaged files, the wheel, and the scripts
# of tests/tools that need nothing of POSIX and no method of the laboratory.
#   bash windows.sh BIN_DIR ARCHIVE [FOLDER [WHEEL PYTHON]]     all by their whole paths. FOLDER: fifty damaged EXR files or
#                                                               more; WHEEL: the one for Windows; PYTHON: the folder of
#                                                               its Python
. "$(dirname "$0")/../tools/check.sh"
. "$source_dir/tests/packaging/windows-programs.sh"
[ $# -ge 2 ] || fail "name an archive of tools/windows.sh"
cmake -E tar xf "$2"
there=$scratch/$(basename "$2" .zip)/bin
windows_programs "$there"
traced fence 160x90 views
for program in "$there"/*.exe; do exits 0 "${program%.exe}" --help; done

# The README's sixty seconds make the files that this machine's programs make. Both ends of a pipe are binary.
sixty_seconds() { # BIN FOLDER
    mkdir "$2"
    "$1/ldi-warp" views/center.exr views/view_?.exr -o - | "$1/ldi-cluster" - -o "$2/fence.ldi.exr"
    exits 0 "$1/dof-gather" "$2/fence.ldi.exr" -o "$2/as-rendered.exr"
    exits 0 "$1/dof-gather" "$2/fence.ldi.exr" --focus-distance 2.2 -o "$2/focus-on-the-fence.png"
    exits 0 "$1/dof-gather" "$2/fence.ldi.exr" --lens-radius 0.02 -o "$2/stopped-down.exr"
}
sixty_seconds "$bin" here
sixty_seconds "$there" there
for file in here/*.exr; do cmp "$file" "there/${file##*/}" || fail "${file##*/} differs"; done
idiff -q here/focus-on-the-fence.png there/focus-on-the-fence.png >stdout || fail "the PNG differs"
exits 0 "$there/dof-compare" here/as-rendered.exr there/as-rendered.exr

# Any name; missing folders are made; a file is replaced, or left as it was if it is read-only or the work fails.
far="Ordner mit Leerzeichen/größer 𝄞/$(printf 'x%.0s' {1..120})/$(printf 'y%.0s' {1..120})"
exits 0 "$there/dof-gather" here/fence.ldi.exr -o "$far/bild ü.exr"
cmp "$far/bild ü.exr" here/as-rendered.exr
exits 0 "$there/dof-gather" here/fence.ldi.exr --lens-radius 0.02 -o "$far/bild ü.exr"
cmp "$far/bild ü.exr" here/stopped-down.exr
chmod a-w "$far/bild ü.exr"
fails_saying 1 'ü.exr: cannot replace' "$there/dof-gather" here/fence.ldi.exr -o "$far/bild ü.exr"
cmp "$far/bild ü.exr" here/stopped-down.exr
fails_saying 1 'kein größeres.exr: cannot open: No such file' "$there/dof-gather" 'kein größeres.exr' -o "$far/new.exr"
cp here/fence.ldi.exr "$far/ldi.exr"
fails_saying 2 'would overwrite the input' "$there/dof-gather" "$far/ldi.exr" -o "$far/../${far##*/}/ldi.exr"
[ "$(find "$far" -type f | wc -l)" -eq 2 ] || fail "temporary files are left: $(ls -a "$far")"

# A full disk, and Ctrl-C in a terminal: what was there is left as it was.
if [ "$(id -u)" -eq 0 ] && mkdir full && mount -t tmpfs -o size=64k tmpfs full 2>/dev/null; then
    trap 'umount "$scratch/full"; rm -rf "$scratch"' EXIT
    echo old >full/x.exr
    fails_saying 1 'full/x.exr: .*No space left' "$there/dof-gather" views/ldi.exr --lens-radius 0.02 -d float -o full/x.exr
    [ "$(cat full/x.exr)" = old ] && [ "$(ls -A full)" = x.exr ] || fail "a full disk: $(ls -lA full)"
fi
mkdir stopped
echo old >stopped/x.exr
cat >press.py <<'PYTHON'
import os, pty, sys, time

process, terminal = pty.fork()
if process == 0:
    os.execv(sys.argv[1], sys.argv[1:])
time.sleep(4)
os.write(terminal, b"\x03")
try:
    while os.read(terminal, 4096):
        pass
except OSError:
    pass # it has ended
assert os.waitstatus_to_exitcode(os.waitpid(process, 0)[1]) != 0
PYTHON
exits 0 python3 press.py "$there/dof-gather" views/ldi.exr --lens-radius 0.1 --lens-samples 200000 -o stopped/x.exr
[ "$(cat stopped/x.exr)" = old ] && [ "$(ls -A stopped)" = x.exr ] || fail "Ctrl-C: $(ls -lA stopped)"

# dof-view answers its page, and refuses what it does not know.
traced fence 96x54 small
exits 0 python3 "$source_dir/tests/viewing/protocol.py" "$there" views/ldi.exr views/reference.exr small/ldi.exr

# Damaged files: one line for each, and no crash.
files=0
for file in ${3+"$3"/*}; do
    [ -f "$file" ] || continue
    code=0
    "$there/dof-gather" "$file" -o damaged.exr >stdout 2>stderr </dev/null || code=$?
    { [ $code -eq 1 ] && [ "$(wc -l <stderr)" -eq 1 ]; } || [ $code -eq 0 ] || fail "$file: exit $code, $(cat stderr)"
    files=$((files + 1))
done
[ $# -eq 2 ] || [ $files -ge 50 ] || fail "$3 has only $files files"

# Where other programs are needed, they are this machine's.
for file in "$bin"/*; do [ -e "$there/${file##*/}" ] || ln -s "$file" "$there/"; done
for script in bad-pixels compression deep-views denoised depth dof-compare dof-finish hostile layers ldi-plan leave-out looks mistakes openexr \
    pictures recolor stats subpixels supersample; do
    exits 0 bash "$source_dir/tests/tools/$script.sh" "$there"
    echo "$script: passed"
done

# The module and the tools of the wheel make the same pictures.
if [ $# -eq 5 ]; then
    python3 -m venv pip
    exits 0 pip/bin/pip -q install --target packages --platform win_amd64 --python-version "$(wine "$5/python.exe" -c \
        'import sys; print("%d.%d" % sys.version_info[:2])' </dev/null | tr -d '\r')" --only-binary :all: "$4" 'numpy<2'
    cat >use.py <<'PYTHON'
import sparselens

ldi = sparselens.open_ldi("here/fence.ldi.exr")
sparselens.write("module.exr", sparselens.gather(ldi))
sparselens.write("module.png", sparselens.gather(ldi, focus_distance=2.2))
PYTHON
    # By pipes: Python in wine refuses files as its streams.
    PATH=$PWD/packages/bin:$PATH PYTHONPATH=packages wine "$5/python.exe" use.py </dev/null 2>&1 | cat >said ||
        fail "the module of the wheel: $(tail -n 3 said)"
    cmp module.exr here/as-rendered.exr || fail "the module makes another picture"
    idiff -q module.png here/focus-on-the-fence.png >stdout || fail "the module makes another PNG"
fi
echo "$(basename "$2"): the same files, and $files damaged files without a crash"
