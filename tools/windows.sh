#!/bin/bash
# Makes the archive of the tools for Windows on x86-64, on a Debian 12 of x86-64.
#
#   tools/windows.sh [FOLDER [ROOT]]     FOLDER: where the archive goes (release); ROOT: the libraries for Windows, which
#                                        are made where they are not there (/var/tmp/sparselens-roots/windows)
#
# An hour on two cores the first time, half of it with a ROOT. As root; needs the net for Debian's packages and sources.
# Debian's mingw-w64 makes the programs (cmake/Mingw.cmake); they need no DLL but the system's. Picture files are PNG and
# JPEG, as in the other archives. tests/packaging/windows.sh tries the archive with wine.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
fail() {
    echo "windows.sh: $*" >&2
    exit 1
}
[ $# -le 2 ] || fail "usage: tools/windows.sh [FOLDER [ROOT]]"
build=$here/build-windows out=${1:-$here/release} root=${2:-/var/tmp/sparselens-roots/windows}
mkdir -p "$build" "$out" "$root"/{include,lib/pkgconfig,share/cmake,sources}
out=$(cd "$out" && pwd) root=$(cd "$root" && pwd)
say() { echo "windows.sh: $* (after $SECONDS s)"; }
logged() { "$@" >"$build/log" 2>&1 </dev/null || fail "$* ($(tail -n 20 "$build/log"))"; }

"$here/tools/install-deps.sh" build python windows

say "the libraries"
mingw=/usr/x86_64-w64-mingw32
cp -ru /usr/include/{CLI,nlohmann,pybind11} $mingw/include/z{lib,conf}.h "$root/include/"
ln -sfn /usr/include/boost "$root/include/boost"
cp -ru /usr/share/cmake/{CLI11,nlohmann_json} /usr/lib/cmake/pybind11 "$root/share/cmake/"
cp -u $mingw/lib/libz.a "$root/lib/"
sed "s,$mingw,$root," $mingw/lib/pkgconfig/zlib.pc >"$root/lib/pkgconfig/zlib.pc"
unpacked() { # SHA256 SOURCE: Debian's source, in $folder; false if it is built already
    folder=$root/sources/$(basename "${2%%_*}")
    [ ! -e "$folder/$1" ] || return 1
    logged curl -fsS -o "$folder.tar" "http://deb.debian.org/debian/pool/main/${2//+/%2b}"
    echo "$1  $folder.tar" | sha256sum -c --quiet || fail "$2 is not the source that was tried"
    rm -rf "$folder" && mkdir -p "$folder/made" && tar -xf "$folder.tar" -C "$folder" --strip-components=1
}
library() { # SHA256 SOURCE FOLDER OPTION...: a static library; FOLDER: where its CMakeLists.txt is
    unpacked "$1" "$2" || return 0
    sed -i '/set(BUILD_SHARED_LIBS/d' "$folder/$3/CMakeLists.txt" # pystring would be a DLL
    logged cmake -S "$folder/$3" -B "$folder/made" -G Ninja --toolchain "$here/cmake/Mingw.cmake" -DSPARSELENS_SYSROOT="$root" \
        -DCMAKE_INSTALL_PREFIX="$root" -DCMAKE_BUILD_TYPE=Release -DBUILD_SHARED_LIBS=OFF -DBUILD_TESTING=OFF "${@:4}"
    logged cmake --build "$folder/made" -j "$(nproc)" --target install
    touch "$folder/$1"
}
# newlib's mathematical functions have the code of glibc, and give the same bits; mingw-w64's do not.
newlib=58dd9e3eaedf519360d92d84205c3deef0b3fc286685d1c562e245914ef72c66
if unpacked $newlib n/newlib/newlib_3.3.0.orig.tar.gz; then
    rm "$folder"/COPYING{,3,.LIB*,3.LIB} # of parts that are not used
    mkdir -p "$folder/made/machine"
    echo '#define __IEEE_LITTLE_ENDIAN' >"$folder/made/machine/ieeefp.h"
    (
        cd "$folder/newlib/libm/common"
        logged x86_64-w64-mingw32-gcc-posix -c -O2 -ffp-contract=off -D_IEEE_LIBM -D__OBSOLETE_MATH=0 -DWANT_ERRNO=0 -D__int32_t=int \
            -D__uint32_t=unsigned -I"$folder/made" -I. {exp,exp2,exp_data,log,log2,log2_data,log_data,pow,pow_log_data,math_err}.c \
            sf_{exp,exp2,exp2_data,log,log2,log2_data,log_data,pow,pow_log2_data,expm1,log1p}.c s_{expm1,log1p}.c \
            {sinf,cosf,sincosf,sincosf_data,math_errf}.c
        logged x86_64-w64-mingw32-ar rcs "$root/lib/libsame-math.a" ./*.o
    )
    touch "$folder/$newlib"
fi
# The module for Python needs its headers, and the names in its DLL, which are those of Debian's.
python=$(/usr/bin/python3 -c 'import sys; print("%d.%d" % sys.version_info[:2])') dll=python${python/./}
headers=2411c74bda5bbcfcddaf4531f66d1adc73f247f529aee981b029513aefdbf849
if unpacked $headers p/python3.11/python3.11_3.11.2.orig.tar.gz; then
    cp -r "$folder/Include" "$root/include/python$python"
    cp "$folder/PC/pyconfig.h" "$root/include/python$python/"
    printf 'LIBRARY %s.dll\nEXPORTS\n' $dll >"$folder/made/names.def"
    nm -D --defined-only "/usr/lib/x86_64-linux-gnu/libpython$python.so.1.0" |
        awk '$3 ~ /^_?Py/ { print $3, $2 ~ /[BDRV]/ ? "DATA" : "" }' >>"$folder/made/names.def"
    logged x86_64-w64-mingw32-dlltool -d "$folder/made/names.def" -l "$root/lib/lib$dll.dll.a"
    touch "$folder/$headers"
fi
library 84ce1c2d0be3a9863935137969dcec6970125caac032f82474640bfc81463583 f/fmtlib/fmtlib_9.1.0+ds1.orig.tar.gz . -DFMT_TEST=OFF -DFMT_DOC=OFF
library ea5592230f5ab917bea3ceab266cf38eb4aa4a523078d46eac0f5a89c52304db i/imath/imath_3.1.6.orig.tar.gz .
library 7e9111b8bb59c8800bf6d0b06afe7b0891937443d2dae1ee1101c8e2ede6a7ef o/onetbb/onetbb_2021.8.0.orig.tar.xz . \
    -DTBB_TEST=OFF -DTBBMALLOC_BUILD=OFF -DTBB_STRICT=OFF
library 93925805c1fc4f8162b35f0ae109c4a75344e6decae5a240afdfce25f8a433ec o/openexr/openexr_3.1.5.orig.tar.gz . \
    -DOPENEXR_BUILD_TOOLS=OFF -DOPENEXR_INSTALL_EXAMPLES=OFF -DCMAKE_C_FLAGS=-Wno-incompatible-pointer-types
library a00e9d2f2f664186e4202db9299397f851aea71b36a35e74910b8820e380d441 libp/libpng1.6/libpng1.6_1.6.39.orig.tar.gz . \
    -DPNG_SHARED=OFF -DPNG_TESTS=OFF
library 254f3642b04e309fee775123133c6464181addc150499561020312ec61c1bf7c libj/libjpeg-turbo/libjpeg-turbo_2.1.5.orig.tar.gz . \
    -DENABLE_SHARED=OFF -DWITH_SIMD=OFF -DWITH_TURBOJPEG=OFF
library ab00ee05c7067fd10a35c5d2a4922ebba746ddd50ff83b79c828da17bbdf1757 e/expat/expat_2.5.0.orig.tar.gz expat \
    -DEXPAT_BUILD_TOOLS=OFF -DEXPAT_BUILD_TESTS=OFF -DEXPAT_BUILD_EXAMPLES=OFF -DEXPAT_SHARED_LIBS=OFF
library dc63708605404e0b963e0ca3a9619d1c8270eda2839603e6fa0384e5e51e5312 y/yaml-cpp/yaml-cpp_0.7.0+dfsg.orig.tar.xz . \
    -DYAML_CPP_BUILD_TESTS=OFF -DYAML_CPP_BUILD_TOOLS=OFF
library 49da0fe2a049340d3c45cce530df63a2278af936003642330287b68cefd788fb p/pystring/pystring_1.1.4.orig.tar.gz .
library 516420206151e76b5515f5ae7e976c97a9920b13dbfb50ceada1dc4bd67116de o/opencolorio/opencolorio_2.1.3+dfsg.orig.tar.xz . \
    -DOCIO_INSTALL_EXT_PACKAGES=NONE -Dpystring_INCLUDE_DIR="$root/sources" -DCMAKE_CXX_FLAGS_RELEASE='-O1 -DNDEBUG' -DOCIO_BUILD_{APPS,TESTS,GPU_TESTS,DOCS,PYTHON,OPENFX}=OFF
# OpenColorIO tells only Linux what it needs. Names of ours are macros in windows.h, which oneTBB includes.
printf '%s\n' 'Name: OpenColorIO' 'Description: colours' 'Version: 2.1.3' "Cflags: -I$root/include" \
    "Libs: -L$root/lib -lOpenColorIO -lyaml-cpp -lpystring -lexpat -lImath-3_1" >"$root/lib/pkgconfig/OpenColorIO.pc"
grep -rl '#.*include <windows.h>' "$root/include" | while read -r file; do
    grep -q '^#undef near' "$file" || sed -i '/#.*include <windows.h>/a #undef near\n#undef far' "$file"
done

say "the build"
cmake -S "$here" -B "$build" --preset release --toolchain "$here/cmake/Mingw.cmake" -DSPARSELENS_SYSROOT="$root" -DHELP2MAN=OFF \
    -DSPARSELENS_{BENCHMARKS,TESTS,LAB,GPU,BUNDLE}=OFF -DSPARSELENS_PYTHON=ON -DSPARSELENS_PYTHON_DIR:STRING=. -DPython_EXECUTABLE=/usr/bin/python3 \
    -DPython_INCLUDE_DIR="$root/include/python$python" -DPython_LIBRARY="$root/lib/lib$dll.dll.a" \
    -DPYTHON_MODULE_EXTENSION=".cp${python/./}-win_amd64.pyd" -DPYBIND11_PYTHON_EXECUTABLE_LAST=/usr/bin/python3 --log-level=WARNING
cmake --build "$build" -j "$(nproc)"

say "the archive"
version=$(sed -nE 's/^project\(sparselens VERSION ([0-9.]+) .*/\1/p' "$here/CMakeLists.txt")
name=sparselens-$version-windows-x86_64
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
logged cmake --install "$build" --prefix "$work/$name" --strip --component tools
mkdir "$work/$name/licences"
cp "$here/LICENSE" "$work/$name/licences/sparselens.txt"
for package in "$(dpkg-query -W -f='${Depends}' libboost-dev)" g++-mingw-w64-x86-64-posix mingw-w64-x86-64-dev libz-mingw-w64-dev libcli11-dev nlohmann-json3-dev; do
    cp -L "/usr/share/doc/$package/copyright" "$work/$name/licences/$package.txt"
done
for folder in "$root"/sources/*/; do
    cat "$folder"/{LICENSE,COPYING}* "$folder"/*/COPYING >"$work/$name/licences/$(basename "$folder").txt" 2>/dev/null || true
done
for file in "$work/$name"/bin/*.exe "$work/$name"/lib/sparselens/*.dll; do
    strangers=$(x86_64-w64-mingw32-objdump -p "$file" | sed -nE 's/.*DLL Name: //p' | grep -viE '^(kernel32|user32|gdi32|advapi32|msvcrt|shell32|ws2_32|mswsock)\.dll$' || true)
    [ -z "$strangers" ] || fail "${file##*/} needs $strangers"
done
cat >"$work/$name/README.txt" <<END
sparselens $version for Windows 10 and later (x86-64): depth of field from a few pinhole renders.

The tools are in bin. Unpack the folder anywhere, and call them by their path or put bin on the PATH:

    set PATH=%CD%\\$name\\bin;%PATH%

share/doc/sparselens/README.md says what they do, and licences under which licences. Picture files are EXR, PNG and JPEG.
END
(cd "$work" && cmake -E tar cf "$out/$name.zip" --format=zip --mtime="$(git -C "$here" log -1 --format=%cs)" "$name")
say "$out/$name.zip: $(($(stat -c %s "$out/$name.zip") / 1000000)) MB"
