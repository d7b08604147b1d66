# Installs the build into a scratch prefix, builds the example of docs/library.md against it with find_package, and runs
# it: it must give the same as the installed dof-gather, in at most eight lines, and without Embree. Every installed
# header compiles on its own, without warnings, from that one folder.
#   bash install.sh BIN_DIR BUILD_DIR COMPILER
. "$(dirname "$0")/../tools/check.sh"
build=$2 compiler=$3 prefix=$scratch/prefix
logged() { "$@" >log 2>&1 || fail "$* ($(cat log))"; }

logged cmake --install "$build" --prefix "$prefix"
expected=$(cd "$bin" && ls -d ldi-* dof-*)
[ "$(ls "$prefix/bin")" = "$(sort <<<"$expected")" ] || fail "installed are $(ls "$prefix/bin" | xargs), not $(xargs <<<"$expected")"
for tool in $expected; do
    for page in "man/man1/$tool.1" "bash-completion/completions/$tool"; do
        [ -s "$prefix/share/$page" ] || fail "share/$page is not installed"
    done
done

for script in sparselens_views.py sparselens_blender/{__init__,panel,command}.py sparselens_blender/blender_manifest.toml; do
    [ -s "$prefix/share/sparselens/blender/$script" ] || fail "the Blender add-on lacks $script"
done
[ -s "$prefix/share/sparselens/lenses/petzval.json" ] || fail "the lenses of docs/looks.md are not installed"
for script in slurm/submit.sh slurm/warp.sh slurm/gather.sh opencue/submit.py python/usd_cameras.py; do
    [ -x "$prefix/share/sparselens/$script" ] || fail "$script is not installed, or is no executable"
done

mkdir consumer
readme_block cpp docs/library.md >consumer/pull-focus.cpp
lines=$(sed -n '/^int main/,/^}/p' consumer/pull-focus.cpp | sed '1d;$d' | wc -l)
[ "$lines" -ge 1 ] && [ "$lines" -le 8 ] || fail "the example's main() has $lines lines"
{
    echo 'cmake_minimum_required(VERSION 3.25)'
    echo 'project(consumer LANGUAGES CXX)'
    readme_block cmake docs/library.md
    echo 'add_library(plugin MODULE pull-focus.cpp)' # needs position-independent code
    echo 'target_link_libraries(plugin PRIVATE sparselens::sparselens)'
} >consumer/CMakeLists.txt
logged cmake -S consumer -B consumer/build -G Ninja -DCMAKE_CXX_COMPILER="$compiler" \
    -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_CXX_FLAGS=-ffp-contract=off -DCMAKE_EXPORT_COMPILE_COMMANDS=ON
logged cmake --build consumer/build -j 2

# Each header alone, compiled like the example but with our warnings: here the library's folder is not a system folder.
# A header that a source of the library or another header includes first was already compiled by itself there, unless
# the build puts something before all sources. Installed headers find each other in the same way, by relative paths
# (tests/scripts/includes.sh). Compiling all of them together shows it.
compile=$(sed -nE 's/^ *"command": "(.*) -o [^ ]+ -c [^ ]*pull-focus\.cpp",?$/\1/p' consumer/build/compile_commands.json | head -n 1)
compile="${compile//-isystem $prefix\/include/-I$prefix/include} -fsyntax-only -x c++ -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror"
[[ $compile == *"-I$prefix/include"* ]] || fail "the example is compiled without the installed headers: $compile"
cd "$prefix/include"
find sparselens -name '*.h' | sort >"$scratch/headers"
[ "$(wc -l <"$scratch/headers")" -ge 50 ] || fail "only $(wc -l <"$scratch/headers") headers are installed"
xargs grep -m 1 -H '^#include' <"$scratch/headers" | sed -nE 's|/[^/]*:#include "(.*)"|/\1|p' | xargs realpath -m --relative-to=. \
    >"$scratch/begun_with"
cd "$scratch"
ninja -C "$build" -t commands sparselens | grep -E -- '-c [^ ]+\.cpp$' >commands
[ "$(wc -l <commands)" -ge 50 ] || fail "the library is compiled from $(wc -l <commands) sources"
grep -q -e ' -include ' commands || grep -oE '[^ ]+\.cpp$' commands | xargs grep -m 1 -h '^#include' |
    sed -nE 's|#include "(.*)"|sparselens/\1|p' >>begun_with
sort -u begun_with | comm -23 headers - >alone
sed 's/.*/#include <&>/' headers >all.h
echo "$scratch/all.h" >>alone
# shellcheck disable=SC2016
xargs -P 2 -I HEADER sh -c 'echo "#include <HEADER>" | $0 - || exit 255' "$compile" <alone >log 2>&1 || fail "a header alone: $(head -n 20 log)"

! grep -ril embree "$prefix/lib"/*/cmake/sparselens "$prefix"/lib/cmake/sparselens 2>/dev/null ||
    fail "the installed package asks for Embree"
! grep -qi embree consumer/build/build.ninja || fail "the consumer is linked with Embree"
ldd consumer/build/pull-focus >libraries
grep -q libc libraries || fail "ldd says nothing"
! grep -i embree libraries || fail "the consumer loads Embree"

logged "$prefix/bin/dof-trace" fence --size 640x40 --views 1 --spp 1 -o views
logged "$prefix/bin/ldi-warp" views/center.exr views/view_0.exr -o fence.ldi.exr
logged consumer/build/pull-focus
logged "$prefix/bin/dof-gather" fence.ldi.exr --focus-distance 3.4 -o expected.exr
logged picture same expected.exr focus-at-3.4.exr

# OpenImageIO is loaded from beside the tools, and only for pictures that need it.
logged "$prefix/bin/dof-gather" fence.ldi.exr -o shown.png
logged oiiotool --info shown.png

# The installed Python module gives the same, if it is built.
module=$(find "$prefix" -name '_sparselens*.so')
if grep -q '^SPARSELENS_PYTHON:BOOL=ON$' "$build/CMakeCache.txt"; then
    [ -n "$module" ] || fail "the Python module is not installed"
    python=$(sed -n 's/^_Python_EXECUTABLE:INTERNAL=//p' "$build/CMakeCache.txt")
    echo 'import sparselens; sparselens.write("python.png", sparselens.gather(sparselens.open_ldi("fence.ldi.exr")))' >use.py
    PYTHONPATH=$(dirname "$(dirname "$module")") logged "$python" use.py
    cmp python.png shown.png || fail "the Python module writes another picture"
    [ -s "$prefix/share/sparselens/python/pull_focus.py" ] || fail "the example in Python is not installed"
fi
rm "$(find "$prefix" -name sparselens-oiio.so)"
logged "$prefix/bin/dof-gather" fence.ldi.exr --focus-distance 3.4 -o expected.exr
fails_saying 1 'cannot load OpenImageIO' "$prefix/bin/dof-gather" fence.ldi.exr -o lost.png
