#!/bin/bash
# The wheel that pyproject.toml describes: it holds the module and the tools and nothing of the laboratory, and in a
# virtual environment without a compiler both work as in the build. Not one of ctest's tests, because it compiles the
# library again, without optimisation, into build-wheel/test: 7 CPU minutes the first time.
#   bash wheel.sh BIN_DIR [PYTHON]
# The build backend, scikit-build-core, is Debian's package if there is one (Debian 13 and later), else PyPI's.
. "$(dirname "$0")/../tools/check.sh"
python=${2:-/usr/bin/python3}
"$python" -c 'import ensurepip, numpy' 2>/dev/null || skip "needs python3-venv and python3-numpy"
logged() { "$@" >log 2>&1 </dev/null || fail "$* ($(tail -n 20 log))"; }
pip=(-m pip --disable-pip-version-check)

# The preset lto: a compiler cache has most of what that compiled, and the reverse.
flags=$("$python" -c 'import json, sys
lto = next(p for p in json.load(open(sys.argv[1]))["configurePresets"] if p["name"] == "lto")["cacheVariables"]
print(*(f"--config-settings=cmake.define.{name}={value}" for name, value in lto.items() if name != "CMAKE_BUILD_TYPE"), sep="\n")' \
    "$source_dir/CMakePresets.json")
mapfile -t unoptimised <<<"--config-settings=cmake.build-type=Debug
--config-settings=cmake.define.SPARSELENS_WERROR=ON
$flags"

"$python" -m venv --system-site-packages build
if ! build/bin/python -c 'import scikit_build_core' 2>/dev/null; then
    build/bin/python "${pip[@]}" install --retries 1 scikit-build-core >log 2>&1 ||
        skip "the wheel: scikit-build-core is not installed, and PyPI cannot be reached"
fi
logged build/bin/python "${pip[@]}" wheel --no-build-isolation --no-deps --no-index --wheel-dir wheels "$source_dir" \
    --config-settings=build-dir="$source_dir/build-wheel/test" "${unoptimised[@]}"
wheels=(wheels/*)
version=$(sed -nE 's/^project\(sparselens VERSION ([0-9.]+) .*/\1/p' "$source_dir/CMakeLists.txt")
tag=$("$python" -c 'import sys; print("cp%d%d" % sys.version_info[:2])')
[[ ${wheels[*]} == wheels/sparselens-"$version"-"$tag"-*.whl ]] || fail "made were ${wheels[*]}, not one of version $version for $tag"
"$python" -m zipfile -l "${wheels[0]}" >list
! grep -E 'dof-(accumulate|trace|report)|test|embree|\.(a|h|cmake) ' list || fail "that is not the product's"

for script in sparselens_views.py sparselens_blender/__init__.py; do
    grep -q "/share/sparselens/blender/$script " list || fail "the Blender add-on lacks $script"
done

# The wheel is used without a compiler and without other files of the build. Tools and module are found as in any
# environment.
"$python" -m venv --system-site-packages --without-pip used
logged build/bin/python "${pip[@]}" --python used/bin/python install --no-index --no-deps "${wheels[0]}"
used() { env -i PATH="$scratch/used/bin" HOME="$scratch" SPARSELENS_NO_HISTORY=1 "$@"; }
for tool in dof-compare dof-finish dof-gather dof-match ldi-cluster ldi-plan ldi-warp; do
    exits 0 used $tool --version
    [ "$(cat stdout)" = "$tool (sparselens) $version" ] || fail "$tool --version says $(cat stdout)"
    [ -s used/share/man/man1/$tool.1 ] || fail "no manual page of $tool"
done
cat >use.py <<'PYTHON'
import sys
import numpy
import sparselens

print(sparselens.__version__, sparselens.__file__)
y, x = numpy.mgrid[0:54, 0:96].astype(numpy.float32)
near = x % 24 < 3
image = numpy.stack([numpy.where(near, 0.1, x / 96), y / 54, numpy.ones_like(x)], axis=2).astype(numpy.float32)
view = sparselens.View(image, numpy.where(near, 2.0, 5.0).astype(numpy.float32), channels=["R", "G", "B"], position=(0, 0),
                       focal_length=50, sensor_width=36, fstop=1.4, focus_distance=5)
ldi = sparselens.warp([view])
sparselens.write("ldi.exr", ldi)
picture = sparselens.gather(sparselens.open_ldi("ldi.exr"))
sparselens.write("python.exr", picture)
sparselens.write("python.png", picture)
PYTHON
exits 0 used python use.py
[ "$(cat stdout)" = "$version $scratch/used/lib/$(basename used/lib/python3*)/site-packages/sparselens/__init__.py" ] ||
    fail "imported was $(cat stdout)"
exits 0 used dof-gather ldi.exr -o tool.exr
cmp tool.exr python.exr || fail "the module and the tool of the wheel make different pictures"
exits 0 "$bin/dof-gather" ldi.exr -o build.exr
cmp tool.exr build.exr || fail "the wheel makes another picture than the build"
exits 0 used dof-gather ldi.exr -o tool.png
cmp tool.png python.png || fail "the module and the tool of the wheel write different PNGs"

# The module refuses an array library that it cannot read (pybind11 before 2.12).
mkdir numpy2
echo '__version__ = "2.0.0"' >numpy2/numpy.py
if grep -q 'knows numpy 1 alone' used/lib/python3*/site-packages/sparselens/_sparselens*.so; then
    exits 1 used python -c 'import sys; sys.path.insert(0, "numpy2"); import sparselens'
    grep -q 'ImportError: .*install numpy 1' stderr || fail "takes numpy 2: $(tail -n 1 stderr)"
fi

# If a linked library is missing, a message says what to do.
module=$(echo used/lib/python3*/site-packages/sparselens/_sparselens*.so)
sed -i 's/libtbb\.so\./libtbc.so./g' "$module"
exits 1 used python -c 'import sparselens'
grep -q 'ImportError: libtbc.*OpenEXR, OpenColorIO, oneTBB' stderr || fail "does not say what is missing: $(tail -n 1 stderr)"
echo "wheel: $(stat -c %s "${wheels[0]}") bytes, $("$python" --version), numpy $("$python" -c 'import numpy; print(numpy.__version__)')," \
    "scikit-build-core $(build/bin/python -c 'import scikit_build_core; print(scikit_build_core.__version__)')"
