# The script of share/opencue, with a stand-in for OpenCue's Python packages that runs at once what Cuebot would start.
# The stand-in was written with the script, from OpenCue's documentation, and has only what the script calls: it shows
# that the script does what is intended. peers.sh shows that OpenCue's own packages accept the job; nothing here shows
# that a Cuebot does.
. "$(dirname "$0")/../tools/check.sh"
command -v python3 >/dev/null || skip "needs python3"

mkdir -p packages/outline/modules
cat >packages/outline/__init__.py <<'END'
class Outline:
    def __init__(self, name, frame_range): self.layers = []
    def add_layer(self, layer): self.layers.append(layer)
END
cat >packages/outline/modules/__init__.py </dev/null
cat >packages/outline/modules/shell.py <<'END'
class Shell:
    def __init__(self, name, command, range, chunk, threadable):
        self.name, self.command, self.range, self.chunk, self.on = name, command, range, chunk, None
    def depend_on(self, layer): self.on = layer.name
END
cat >packages/outline/cuerun.py <<'END'
import subprocess
def launch(job, use_pycuerun):
    assert not use_pycuerun
    for layer in job.layers:
        first, last = map(int, layer.range.split("-"))
        for start in range(first, last + 1, layer.chunk):
            end = min(start + layer.chunk - 1, last)
            command = " ".join(layer.command).replace("#FRAME_START#", str(start)).replace("#FRAME_END#", str(end))
            print(layer.name, layer.on, f"{start}-{end}", flush=True)
            subprocess.run(["sh", "-c", command], check=True)
END
export PYTHONPATH=$scratch/packages PATH=$bin:$PATH

dof-trace fence --size 48x27 --views 2 --spp 1 -o still
mkdir 'the views'
for number in 0001 0002 0003; do
    for file in center view_0 view_1; do cp still/$file.exr "the views/$file.$number.exr"; done
done
ldi-warp still/center.exr still/view_0.exr still/view_1.exr -o - | dof-gather - -o expected.exr --focus-distance 3
submit=("$source_dir/share/opencue/submit.py" --frames 1-3 --output out)
exits 0 "${submit[@]}" --views 'the views' --chunk 2 -- --focus-distance 3
printf '%s\n' 'warp None 1-2' 'warp None 3-3' 'gather warp 1-2' 'gather warp 3-3' | cmp - stdout || fail "layers: $(cat stdout)"
for number in 0001 0002 0003; do cmp out/picture.$number.exr expected.exr || fail "frame $number"; done
fails_saying 1 'still holds no view_' "${submit[@]}" --views still
# Blender makes the pictures of a scene: one layer, each word apart.
mkdir stand-in
printf '%s\n' '#!/bin/sh' 'printf "%s|" "$@" >>asked' 'echo >>asked' >stand-in/blender
chmod +x stand-in/blender
exits 0 env PATH="$PWD/stand-in:$PATH" "${submit[@]}" --scene 'my shot.blend' --chunk 2 -- --samples 4
[ "$(cat stdout)" = "$(printf '%s\n' 'picture None 1-2' 'picture None 3-3')" ] || fail "layers: $(cat stdout)"
exits 0 env PATH="$PWD/stand-in:$PATH" "${submit[@]}" --scene a.blend --script 'the views.py' --chunk 3
printf '%s\n' '-b|my shot.blend|--command|sparselens|-o|out/####|--frames=1-2|--samples|4|' \
    '-b|my shot.blend|--command|sparselens|-o|out/####|--frames=3-3|--samples|4|' \
    '-b|a.blend|-P|the views.py|--|--picture|-o|out/####|--frames=1-3|' | cmp - asked || fail "Blender: $(cat asked)"
exits 2 "${submit[@]}" --views 'the views' --script x.py
grep -q 'error: --script needs --scene' stderr || fail "--script: $(cat stderr)"
for frames in 1-24x2 1-20:4 1,3,5 1-3,7; do
    exits 2 "${submit[@]}" --views 'the views' --frames "$frames" --chunk 2
    grep -q 'needs frames in a row' stderr || fail "--chunk 2 --frames $frames: $(cat stderr)"
done
for chunk in 0 -1 x; do
    exits 2 "${submit[@]}" --views 'the views' --chunk="$chunk"
    grep -q 'is not a number from 1' stderr || fail "--chunk $chunk: $(cat stderr)"
done
