#!/bin/bash
# Makes an archive of the tools for any Linux of this machine's kind, x86-64 or 64-bit ARM: unpack it anywhere, and run
# what is in its bin/.
#
#   tools/bundle.sh BUILD [FOLDER [unpacked]]     BUILD: a finished build folder; FOLDER: where the archive goes (here)
#
# Writes sparselens-VERSION-linux-MACHINE.tar.xz, or with `unpacked` the folder in it. It holds the
# tools, dof-trace of the laboratory, all libraries that they need with their loader, the Blender add-on as a zip, and
# the licences of all of it. The tools start through the loader in the archive, so the system's C library may be older
# or newer. In the place of OpenImageIO there is a module that writes PNG, and reads PNG and JPEG
# (src/io/display/small_module.cpp); other formats are missing, and so is the plug-in for OpenImageIO. Needs the Debian
# packages of tools/install-deps.sh build bundle.
#
# The Python module is missing, too, because the archive must stay below 120 MB. The module works with one version of
# Python and one C library only, so the archive would need a Python interpreter (7 MB), its library (9), NumPy (13),
# LAPACK (11) and the module (6): 46 MB. The archive already has 100 MB. dof-trace and Embree take 48 of them; the
# README's example needs both.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
fail() {
    echo "bundle.sh: $*" >&2
    exit 1
}
case $#:${3-unpacked} in [1-3]:unpacked) ;; *) fail "usage: tools/bundle.sh BUILD [FOLDER [unpacked]]" ;; esac
build=$(cd "$1" 2>/dev/null && pwd) && [ -s "$build/CMakeCache.txt" ] || fail "$1 is not a build folder: cmake -S . -B $1 && cmake --build $1"
out=$(cd "${2:-.}" && pwd) || fail "${2:-.} is not a folder"
machine=$(uname -m)
case $machine in
x86_64) kind=x86-64 loader_name=ld-linux-x86-64.so.2 ;;
aarch64) kind='64-bit ARM' loader_name=ld-linux-aarch64.so.1 ;;
*) fail "the archive is of x86-64 or 64-bit ARM, not of $machine" ;;
esac
png=$build/bundle/sparselens-small.so
[ -s "$png" ] || fail "$build has no sparselens-small.so: tools/install-deps.sh bundle, and build again"
cached() { sed -n "s/^$1:[A-Z]*=//p" "$build/CMakeCache.txt"; }
version=$(sed -nE 's/^project\(sparselens VERSION ([0-9.]+) .*/\1/p' "$here/CMakeLists.txt")
name=sparselens-$version-linux-$machine
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
root=$work/$name

# The installation, without what a development needs.
for component in tools lab; do
    cmake --install "$build" --prefix "$root" --strip --component $component >"$work/log" 2>&1 || fail "$(grep -m 1 . "$work/log")"
done
modules=$root/$(cached CMAKE_INSTALL_LIBDIR)/sparselens
[ -d "$modules" ] || modules=$root/lib/sparselens
[ -s "$modules/sparselens-oiio.so" ] || fail "the installation has no sparselens-oiio.so"
install -s "$png" "$modules/sparselens-oiio.so"
rm -rf "$modules/openimageio" # a plug-in belongs to the OpenImageIO of the program that loads it
find "$root" -name 'dof-accumulate*' -o -name 'dof-report*' | xargs -r rm
mkdir -p "$root/libexec" "$root/licences"
mv "$root"/bin/* "$root/libexec/"

# The libraries by the names by which they are loaded, and the loader. TBB loads its allocator by name, if it is there.
programs() { find "$root/libexec" "$root/lib" -type f \( -path '*/libexec/*' -o -name '*.so*' \); }
needed() {
    programs | while read -r file; do ldd "$file"; done | sed -nE 's,^\t(.* => )?(/[^ ]+) \(0x.*,\2,p'
    ls "$(dirname "$(ldd "$root/libexec/dof-gather" | sed -nE 's,.*libtbb\.so\.[0-9]+ => ([^ ]+) .*,\1,p')")"/libtbbmalloc.so.2 2>/dev/null || true
}
mapfile -t libraries < <(needed | sort -u)
for library in "${libraries[@]}"; do cp -L "$library" "$root/lib/${library##*/}"; done
loader=$root/lib/$loader_name
[ -s "$loader" ] || fail "the loader is not among: ${libraries[*]}"

# Each tool starts by a script of its name.
sed "s/LOADER/$loader_name/" >"$work/start" <<'END'
#!/bin/sh
# Starts the program of this name in libexec by the loader and the libraries of this folder, whatever the PATH is.
self=$(command -p readlink -f "$0")
root=${self%/bin/*}
exec "$root/lib/LOADER" --argv0 "$self" --library-path "$root/lib" "$root/libexec/${self##*/}" "$@"
END
for program in "$root"/libexec/*; do install -m 755 "$work/start" "$root/bin/${program##*/}"; done

# Everything is found within the archive.
while read -r file; do
    found=$("$loader" --inhibit-cache --library-path "$root/lib" --list "$file" 2>&1) || fail "${file#"$root"/}: $found"
    strangers=$(sed -nE 's,^\t(.* => )?(/[^ ]+) \(0x.*,\2,p' <<<"$found" | grep -vF "$root/" || true)
    [ -z "$strangers" ] || fail "${file#"$root"/} loads $strangers"
done < <(programs | grep -v '/ld-linux')

# The licences: of the packages that the libraries and the headers are from, and the texts that these name.
package_of() {
    { dpkg-query -S "$1" "${1#/usr}" "/usr$1" "$(readlink -f "$1")" 2>/dev/null || true; } |
        sed '/^diversion by /d; s/: .*//; s/, .*//' | sed -n 1p
}
{
    for library in "${libraries[@]}" /usr/include/boost/beast.hpp; do package_of "$library"; done
    dpkg-query -W -f='${Package}\n' libcli11-dev nlohmann-json3-dev libvulkan-dev 2>/dev/null # headers
} | sed 's/:[a-z0-9]*$//' | sort -u >"$work/packages"
cp "$here/LICENSE" "$root/licences/sparselens.txt"
cp -rL /usr/share/common-licenses "$root/licences/common-licenses"
while read -r package; do
    cp -L "/usr/share/doc/$package/copyright" "$root/licences/$package.txt" || fail "$package has no licence"
done <"$work/packages"
{
    echo "sparselens $version is under the Apache License 2.0 (sparselens.txt). The archive also holds, unchanged, parts of these"
    echo "packages of Debian, whose licences are beside this file. Their sources: https://sources.debian.org"
    echo
    xargs dpkg-query -W -f='${Package} ${Version}, source ${source:Package} ${source:Version}\n' <"$work/packages"
} >"$root/licences/README.txt"

# The add-on as Blender installs it.
(cd "$root/share/sparselens/blender" && cmake -E tar cf sparselens_blender.zip --format=zip sparselens_blender)
cat >"$root/README.txt" <<END
sparselens $version for Linux ($kind): depth of field from a few pinhole renders.

The tools are in bin/. Unpack the folder anywhere, and call them by their path or put bin/ on the PATH:

    export PATH=$name/bin:\$PATH

share/doc/sparselens/README.md says what they do, and licences/ under which licences. In Blender, install
share/sparselens/blender/sparselens_blender.zip as an add-on. Its preferences have "Install Tools", which takes the archive;
or name bin/ there.

The Python module is not here, because it works with one version of Python only: the wheel has it.

EXR is that of OpenEXR $(dpkg-query -W -f='${Version}' libopenexr-dev | sed 's/-.*//'). Files of newer compressions: oiiotool IN --compression zips -o OUT.exr.
END

size="unpacked $(($(du -s --apparent-size -B1 "$root" | cut -f1) / 1000000)) MB"
if [ $# -eq 3 ]; then
    mv "$root" "$out/"
    echo "$out/$name: $size"
    exit
fi
archive=$out/$name.tar.xz
tar -ch --hard-dereference -C "$work" --sort=name --owner=0 --group=0 --numeric-owner --mtime="@$(git -C "$here" log -1 --format=%ct 2>/dev/null || echo 0)" "$name" |
    xz -T0 >"$archive.partial"
mv "$archive.partial" "$archive"
echo "$archive: $(($(stat -c %s "$archive") / 1000000)) MB, $size"
