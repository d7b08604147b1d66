#!/bin/bash
# The looks in the panel of the Blender add-on are those of the tools: dof-view tells their names, help and ranges, and
# dof-gather takes both ends of each range. A build makes the list that is installed; its copy for those who zip
# share/blender without a build, looks.json, may lack new looks.
. "$(dirname "$0")/check.sh"
picture make flat.exr 24x16 R=0.1 G=0.5 B=0.2 A=1 Z=3
copy=$source_dir/share/blender/sparselens_blender/looks.json looks=$bin/../share/blender/looks.json
lens=(--focal-length 50 --sensor-width 36 --fstop 2 --focus-distance 2)
cat >compare.py <<'END'
import json
import subprocess
import sys

sys.path.insert(0, sys.argv[1])
from served import served

looks, copy, program, flat, lens = sys.argv[2], sys.argv[3], sys.argv[4], sys.argv[5], sys.argv[6:]


def read(path):
    with open(path, encoding="utf-8") as file:
        return {look["name"]: look for look in json.load(file)}


shown = read(looks)
for name, look in read(copy).items():
    assert look == shown.get(name), f"{copy}: {name}: {look}, not {shown.get(name)}: cp {looks} {copy}"
with served(program + "/dof-view", flat, *lens) as server:
    told = {look["name"]: look for look in server.said("/facts")["looks"]}
OF_THE_CAMERA = {"blades", "blade-rotation", "squeeze"}  # Blender's own fields
missing = set(told) - set(shown) - OF_THE_CAMERA - {"lens"}
assert not missing, f"looks.json lacks {missing}"
for name, look in shown.items():
    for key in set(look) & set(told.get(name, ())):
        assert look[key] == told[name][key], f"{name}: {key}: {look[key]!r}, not {told[name][key]!r}"
    words = {"number": lambda: [[str(look["low"])], [str(look["high"])], [str(look["usual"])]],
             "pair": lambda: [["-60,60"], ["60,-60"]],
             "choice": lambda: [[]] if look["words"] == ["on"] else [[word] for word in look["words"]]}[look["control"]]()
    for value in words:
        if name in ("highlight-threshold", "highlight-knee"):
            value = [*(value if value != ["0"] else ["0.001"]), "--highlight-gain", "2"]  # acts with the gain alone
        done = subprocess.run([program + "/dof-gather", flat, *lens, "-o", "x.exr", "--" + name, *value], capture_output=True, text=True)
        assert done.returncode == 0, f"--{name} {value}: {done.stderr}"
END
PYTHONDONTWRITEBYTECODE=1 exits 0 python3 compare.py "$source_dir/tests/viewing" "$looks" "$copy" "$bin" flat.exr "${lens[@]}"
