#!/bin/bash
# dof-compare --flip compared with flip-evaluator (PyPI), by the authors of FLIP: the means of ten pairs, LDR and HDR,
# within 1e-3, and the maps within 5e-3 per pixel.
. "$(dirname "$0")/../../../tests/tools/check.sh"
python3 -c 'import ensurepip' 2>/dev/null || skip "needs python3-venv"
python3 -m venv peers
peers/bin/pip -q --disable-pip-version-check install --retries 1 flip-evaluator numpy >installed 2>&1 ||
    skip "flip-evaluator: PyPI cannot be reached, or has no wheel for this Python"

for scene in fence grass mirror mist lamps; do
    exits 0 "$bin/dof-trace" $scene --size 160x90 --views 2 --spp 4 --reference 64 -o $scene
    exits 0 "$bin/dof-trace" $scene --size 160x90 --views 0 --spp 1 --reference 4 --seed 3 -o $scene/few
    "$bin/ldi-warp" $scene/center.exr $scene/view_?.exr -o - | "$bin/dof-gather" - -o $scene/sparse.exr
    pairs+=("$scene/few/reference.exr $scene/reference.exr" "$scene/sparse.exr $scene/reference.exr")
done
[ ${#pairs[@]} -eq 10 ] || fail "${#pairs[@]} pairs"
for i in "${!pairs[@]}"; do
    for range in ldr hdr; do
        # shellcheck disable=SC2086
        exits 0 "$bin/dof-compare" ${pairs[i]} --json --flip $range --flip-map $range$i.exr
        mv stdout $range$i.json
    done
done
printf '%s\n' "${pairs[@]}" >pairs
cat >agree.py <<'PYTHON'
import json
import flip_evaluator as flip
import numpy

for i, (picture, reference) in enumerate(line.split() for line in open("pairs")):
    for kind in "ldr", "hdr":
        theirs, mean, _ = flip.evaluate(flip.load(reference), flip.load(picture), kind, inputsRGB=False, applyMagma=False)
        ours = json.load(open(f"{kind}{i}.json"))["flip"]
        away = numpy.abs(flip.load(f"{kind}{i}.exr")[..., 0] - theirs.reshape(theirs.shape[:2])).max()
        print(f"{picture} {kind}: {ours:.6f}, {mean:.6f}; a pixel at most {away:.6f} away")
        assert ours > 0.01, "nothing to compare"
        assert abs(ours - mean) < 1e-3 and away < 5e-3
PYTHON
peers/bin/python agree.py || fail "FLIP is not what its authors' program finds"
