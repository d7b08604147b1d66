#!/bin/bash
# The module for Python of OpenEXR's own project (OpenEXR, PyPI) opens what the tools write, as numpy arrays with the
# values that stand in the file; and files that it writes by the compressions of OpenEXR 3.4 and 3.5 are read, or one
# line says what to do.
. "$(dirname "$0")/check.sh"
pypi OpenEXR
lens=(--focal-length 50 --sensor-width 36 --lens-radius 0.1 --focus-distance 2)

cat >arrays.py <<'END'
"""arrays.py IN OUT COMPRESSION [NAME...]: writes anew, from numpy arrays, what the module reads; it must have NAMEs."""
import sys

import numpy
import OpenEXR

path, out, compression, names = sys.argv[1], sys.argv[2], sys.argv[3], sys.argv[4:]
file = OpenEXR.File(path, separate_channels=True)
header = file.header()
arrays = {name: channel.pixels for name, channel in file.channels().items()}
missing = set(names) - set(arrays)
assert not missing, f"{path}: no {missing} among {list(arrays)}"
(low, high), deep = header["dataWindow"], header["type"] == OpenEXR.deepscanline
for name, array in arrays.items():
    assert array.shape == (high[1] - low[1] + 1, high[0] - low[0] + 1), f"{path}: {name} has {array.shape}"
    assert (array.dtype == object) == deep, f"{path}: {name} has {array.dtype}"
if deep:
    depths = [z for z in arrays["Z"].flat if z is not None]
    assert max(len(z) for z in depths) > 1, f"{path}: no pixel has several samples"
    if "ldi.weight" in arrays:
        assert all((numpy.diff(z) > 0).all() for z in depths), f"{path}: depths do not ascend"
kept = {name: header[name] for name in ("type", "dataWindow", "displayWindow")}
OpenEXR.File({**kept, "compression": getattr(OpenEXR, compression.upper() + "_COMPRESSION")}, arrays).write(out)
END
by_module() { # IN OUT COMPRESSION NAME...
    "$pypi_python" arrays.py "$@" >said 2>&1 || fail "OpenEXR's module and $1: $(tail -n 2 said)"
}

# What the tools write: views flat and deep, LDIs of surfaces, of images in a mirror and of volumes, pictures, depth.
traced fence 96x54
exits 0 "$bin/dof-trace" plane-mirror --size 96x54 --views 4 --spp 4 -o mirror
exits 0 "$bin/dof-trace" mist --size 48x27 --views 4 --spp 2 --deep views -o mist
exits 0 "$bin/ldi-warp" mirror/center.exr mirror/view_{0..3}.exr -o mirror.exr
exits 0 "$bin/ldi-warp" mist/deep_view_{0..3}.exr -o mist.exr
exits 0 "$bin/ldi-cluster" ldi.exr -o clustered.exr
exits 0 "$bin/dof-gather" ldi.exr -o picture.exr --depth-out depth.exr
for file in "center.exr R G B A Z" "view_0.exr R G B A Z" "mist/deep_view_0.exr Z ZBack A" "ldi.exr Z A ldi.dx ldi.dy ldi.weight" \
    "mirror.exr Z A ldi.optical" "mist.exr Z ZBack A ldi.weight" "clustered.exr Z A ldi.weight" "picture.exr R G B A" "depth.exr Z"; do
    read -ra words <<<"$file"
    by_module "${words[0]}" again.exr no "${words[@]:1}"
    picture same "${words[0]}" again.exr >found || fail "OpenEXR's module reads other values: $(cat found)"
done

# Each new compression: this OpenEXR has it, or the tool says which one does.
has() { "$bin/dof-gather" --help | grep -E -- "--compression .*\|$1(\||$)" >/dev/null; }
gathered() { exits 0 "$bin/dof-gather" "$1" -o "$2" "${lens[@]}" -d float "${@:3}"; }
same() { picture same "$@" >found || fail "$1 and $2: $(cat found)"; }
for made in htj2k256:center.exr htj2k32:center.exr lj2k:center.exr zstd:center.exr zstd:ldi.exr; do
    method=${made%:*} from=${made#*:} tolerance=0
    [ $method != lj2k ] || tolerance=0.05
    by_module "$from" "$method.exr" $method
    if ! has $method; then
        fails_saying 1 "^dof-gather: $method.exr: compressed by a newer OpenEXR than [0-9.]+ \(${method^^}, 3.[45]\): where that is, oiiotool IN --compression zips -o OUT.exr$" \
            "$bin/dof-gather" $method.exr -o out.exr "${lens[@]}"
        continue
    fi
    gathered $method.exr out.exr
    by_module "$from" plain.exr zips # without the header of the tools, like the other
    gathered plain.exr expected.exr
    same out.exr expected.exr $tolerance
    gathered plain.exr ours.exr --compression $method
    same ours.exr expected.exr $tolerance
    by_module ours.exr again.exr no R G B A
    same ours.exr again.exr
    [ "$from" = ldi.exr ] || continue
    exits 0 "$bin/ldi-cluster" "$from" -o ours.exr --tolerance 0 --compression $method
    by_module ours.exr again.exr zips Z A ldi.weight
    same ours.exr again.exr
done
