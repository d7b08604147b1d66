# The templates of share/openjd with the specification's own tool, and the script of share/opencue with OpenCue's own
# Python packages, from PyPI in a virtual environment. For OpenCue all is real except the server: the job is built and
# written in the form in which it would be sent.
. "$(dirname "$0")/../tools/check.sh"
python3 -c 'import ensurepip' 2>/dev/null || skip "needs python3-venv"
python3 -m venv peers
peers/bin/pip -q --disable-pip-version-check install --retries 1 openjd-cli opencue-pycue opencue-pyoutline packaging >installed 2>&1 ||
    skip "openjd-cli and OpenCue's packages: PyPI cannot be reached"
PATH=$bin:$PWD/peers/bin:$PATH

dof-trace fence --size 48x27 --views 2 --spp 1 -o still
mkdir views
for number in 00{01..12}; do
    for file in center view_0 view_1; do cp still/$file.exr views/$file.$number.exr; done
done
ldi-warp still/center.exr still/view_0.exr still/view_1.exr -o - | dof-gather - -o expected.exr --focus-distance 3
for template in "$source_dir"/share/openjd/*.yaml; do
    exits 0 openjd check "$template" --extensions TASK_CHUNKING
    rm -rf out
    exits 0 openjd run "$template" --extensions TASK_CHUNKING --step gather --run-dependencies -p Views="$PWD/views" \
        -p Output="$PWD/out" -p Frames=1-12 -p LensOptions='--focus-distance 3'
    for number in 00{01..12}; do cmp out/picture.$number.exr expected.exr || fail "$template: frame $number"; done
    # A list of frames of more than 128 characters does not become part of the job's name.
    exits 0 openjd run "$template" --extensions TASK_CHUNKING --step gather --run-dependencies -p Views="$PWD/views" \
        -p Output="$PWD/out" -p Frames="$(for n in {1..11}; do printf '%s-%s:1000000,' $n $n; done)12"
done
exits 0 openjd check "$source_dir/share/openjd/blender/template.yaml"

cat >submit.py <<'END'
import runpy, sys
import opencue.api
def sent(spec, *others):
    print(spec)
    return [None]
opencue.api.launchSpecAndWait = sent
sys.argv = sys.argv[1:]
runpy.run_path(sys.argv[0], run_name="__main__")
END
exits 0 env USER=artist peers/bin/python submit.py "$source_dir/share/opencue/submit.py" --frames 1-12 --views "$PWD/views" \
    --output "$PWD/out" --chunk 4 -- --focus-distance 3
cat >layers.py <<'END'
import sys, xml.etree.ElementTree as xml
spec = xml.fromstring(sys.stdin.read())
for layer in spec.iter("layer"):
    print(layer.get("name"), layer.findtext("range"), layer.findtext("chunk"), layer.findtext("cmd").split()[0])
for depend in spec.iter("depend"):
    print(depend.get("type"), depend.findtext("deplayer"), depend.findtext("onlayer"))
END
python3 layers.py <stdout >layers || fail "OpenCue's job: $(cat stdout)"
printf '%s\n' 'warp 1-12 4 ldi-warp' 'gather 1-12 4 dof-gather' 'FRAME_BY_FRAME gather warp' | cmp - layers || fail "OpenCue's job: $(cat layers)"
