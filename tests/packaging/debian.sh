# The Debian packages made by cpack: lintian finds no errors, they install into an empty root with the host's list of
# installed packages, the tools run from there, and a program builds with the library from there.
#   bash debian.sh BIN_DIR BUILD_DIR
. "$(dirname "$0")/../tools/check.sh"
build=$(cd "$2" && pwd)
for program in cpack dpkg-deb dpkg-shlibdeps fakeroot file; do
    command -v $program >/dev/null || skip "needs $program (cmake, dpkg-dev, fakeroot, file)"
done
[ -f "$build/CPackConfig.cmake" ] || skip "there are packages of the static library only"
logged() { "$@" >log 2>&1 || fail "$* ($(tail -20 log))"; }

logged cpack --config "$build/CPackConfig.cmake" -G DEB -B "$scratch/packages" -D CPACK_DEBIAN_COMPRESSION_TYPE=gzip # the fastest
packages=(packages/*.deb)
names=(sparselens sparselens-lab libsparselens-dev)
if grep -q '^SPARSELENS_PYTHON:BOOL=ON$' "$build/CMakeCache.txt"; then names+=(python3-sparselens); fi
for name in "${names[@]}"; do
    ls packages/${name}_[0-9]*.deb >/dev/null || fail "no package $name: ${packages[*]}"
done
if command -v lintian >/dev/null; then
    lintian --allow-root "${packages[@]}" >lintian.log 2>&1 || true
    ! grep '^E:' lintian.log || fail "lintian finds errors"
else
    echo "skipped: lintian is not installed"
fi

# dpkg checks the dependencies, against the host's list of packages.
root=$scratch/root
mkdir -p "$root"/var/lib/dpkg/{info,updates,triggers}
awk 'BEGIN { RS = ""; ORS = "\n\n" } !/^Package: (lib|python3-)?sparselens/' /var/lib/dpkg/status >"$root/var/lib/dpkg/status"
logged fakeroot dpkg --root="$root" --force-not-root --force-script-chrootless --force-unsafe-io --log="$scratch/dpkg.log" -i "${packages[@]}"
for package in "${names[@]}"; do
    dpkg-query --admindir="$root/var/lib/dpkg" -W -f='${db:Status-Abbrev}' $package | grep -q '^ii' || fail "$package is not installed"
done
expected=$(cd "$bin" && ls -d ldi-* dof-*)
[ "$(ls "$root/usr/bin")" = "$(sort <<<"$expected")" ] || fail "installed are $(ls "$root/usr/bin" | xargs), not $(xargs <<<"$expected")"
for name in $expected; do
    for file in bin/$name share/man/man1/$name.1.gz share/bash-completion/completions/$name; do
        [ -s "$root/usr/$file" ] || fail "/usr/$file is in no package"
    done
    if readelf -d "$root/usr/bin/$name" | grep -E 'R(UN)?PATH'; then fail "$name looks for libraries in a folder of its own"; fi
done
[ -s "$root/usr/lib/sparselens/openimageio/dof.imageio.so" ] || fail "the reader for OpenImageIO is in no package"
[ -s "$root/usr/OFX/Plugins/SparseLens.ofx.bundle/Contents/Linux-x86-64/SparseLens.ofx" ] || [ "$(uname -m)" != x86_64 ] ||
    fail "the effect for OpenFX is in no package"
for script in slurm/submit.sh openjd/template.yaml opencue/submit.py blender/sparselens_{views.py,blender/{__init__,panel,command}.py}; do
    [ -s "$root/usr/share/sparselens/$script" ] || fail "$script is in no package"
done

# Runs the tools: inside the root, with the libraries that they are linked with; else from there, with the host's.
mkdir "$root/work"
if [ "$(id -u)" -eq 0 ] && chroot / true 2>/dev/null; then
    { ldd "$root"/usr/bin/* || true; } | grep -oE '/[^ :]+' | sort -u | while read -r library; do
        [[ $library != "$root"* ]] || continue
        mkdir -p "$root${library%/*}" && cp -L "$library" "$root$library"
    done
    work=/work
    installed() { exits 0 env -i "$(command -v chroot)" "$root" "/usr/bin/$1" "${@:2}"; }
else
    echo "skipped: the tools in the root itself: only root may change it"
    work=$root/work
    installed() { exits 0 env -i "$root/usr/bin/$1" "${@:2}"; }
fi
installed dof-trace fence --size 48x27 --views 1 --spp 1 -o $work/views
installed ldi-warp $work/views/center.exr $work/views/view_0.exr -o $work/ldi.exr --no-history
installed dof-gather $work/ldi.exr -o $work/picture.exr --no-history
exits 0 "$bin/ldi-warp" "$root/work/views/center.exr" "$root/work/views/view_0.exr" -o ldi.exr
exits 0 "$bin/dof-gather" ldi.exr -o picture.exr
cmp picture.exr "$root/work/picture.exr" || fail "the installed tools make another picture"
exits 0 env -i "$root/usr/bin/dof-gather" ldi.exr -o picture.png # by the module in /usr/lib/sparselens, with the host's libraries
[ -s picture.png ] || fail "no PNG"

# The Python module, found in the folder where Debian's Python searches.
if [[ " ${names[*]} " == *' python3-sparselens '* ]]; then
    python=$(sed -n 's/^_Python_EXECUTABLE:INTERNAL=//p' "$build/CMakeCache.txt")
    module=$root/usr/lib/python3/dist-packages
    [ -s "$module/sparselens/__init__.pyi" ] || fail "the module lies elsewhere: $(cd "$root" && find . -name '_sparselens*')"
    cat >use.py <<END
import sparselens
assert sparselens.__file__.startswith("$module"), sparselens.__file__
sparselens.write("python.exr", sparselens.gather(sparselens.open_ldi("ldi.exr")))
sparselens.write("python.png", sparselens.gather(sparselens.open_ldi("ldi.exr")))
END
    PYTHONPATH=$module PYTHONDONTWRITEBYTECODE=1 logged "$python" use.py
    cmp picture.exr python.exr || fail "the installed module makes another picture"
    cmp picture.png python.png || fail "the installed module writes another PNG"
fi

# A program built with the library from the root.
mkdir consumer
readme_block cpp docs/library.md >consumer/pull-focus.cpp
{
    echo 'cmake_minimum_required(VERSION 3.25)'
    echo 'project(consumer LANGUAGES CXX)'
    readme_block cmake docs/library.md
} >consumer/CMakeLists.txt
logged cmake -S consumer -B consumer/build -G Ninja -DCMAKE_PREFIX_PATH="$root/usr" -DCMAKE_CXX_FLAGS=-ffp-contract=off
grep -q "sparselens_DIR:PATH=$root/usr/lib/" consumer/build/CMakeCache.txt || fail "another sparselens was found"
logged cmake --build consumer/build
