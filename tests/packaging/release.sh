#!/bin/bash
# The files of tools/release.sh, as users take them: checksums, the page, the wheel in an environment of its own, the zip in
# Blender, and with SUITE in roots of Debian that have nothing else: the archive in each (bullseye, bookworm, sid), the
# wheel and the packages in bookworm.
#   bash release.sh FOLDER [SUITE...]
. "$(dirname "$0")/../tools/check.sh"
made=$bin suites=("${@:2}") # check.sh calls the folder so
version=$(sed -nE 's/^project\(sparselens VERSION ([0-9.]+) .*/\1/p' "$source_dir/CMakeLists.txt")
archive=$made/sparselens-$version-linux-x86_64.tar.xz zip=$made/sparselens_blender-$version-linux.zip
logged() { "$@" >log 2>&1 </dev/null || fail "$* ($(tail -n 20 log))"; }

(cd "$made" && sha256sum --quiet -c SHA256SUMS) || fail "other checksums"
for file in "$made"/*; do
    [[ $file == */index.html || $file == */SHA256SUMS ]] || grep -q "href=\"${file##*/}\"" "$made/index.html" || fail "the page lacks ${file##*/}"
    [[ $file == */SHA256SUMS ]] || grep -q " ${file##*/}$" "$made/SHA256SUMS" || fail "no checksum of ${file##*/}"
done

# The wheel: nothing of the system but the libraries of the compilers; the same picture by the tool and the module.
wheel=$(echo "$made"/sparselens-"$version"-cp3*-manylinux_2_*_x86_64.whl)
use_wheel='set -eu; cd "$1"; python3 -m venv env; env/bin/pip -q --disable-pip-version-check install "$2"
    export PATH=$PWD/env/bin SPARSELENS_NO_HISTORY=1
    python3 -c "
import numpy, sparselens
ramp = numpy.linspace(0, 1, 96 * 54, dtype=numpy.float32).reshape(54, 96)
view = sparselens.View(numpy.stack([ramp] * 3, 2), 1 + ramp, channels=list(\"RGB\"), focal_length=50, sensor_width=36,
                       fstop=1.4, focus_distance=1.5, position=(0, 0))
sparselens.write(\"l.exr\", sparselens.warp([view]))
sparselens.write(\"module.exr\", sparselens.gather(sparselens.open_ldi(\"l.exr\")))"
    dof-gather l.exr -o tool.exr
    dof-gather l.exr -o tool.png
    dof-gather tool.png --depth-file tool.png --blur 5 --focus-pixel 8,9 -o photograph.png
    [ -s photograph.png ]'
logged env -i HOME="$scratch" PATH=/usr/bin:/bin bash -c "$use_wheel" - "$scratch" "$wheel"
cmp module.exr tool.exr || fail "the module and the tool of the wheel make different pictures"
strangers=$(ldd env/bin/dof-gather env/lib/python3*/site-packages/sparselens/*.so env/lib/sparselens/libs/* | grep '=>' |
    grep -vE " => $scratch/|lib(c|m|dl|rt|pthread|gcc_s|stdc\+\+)\.so\.[0-9]+ " || true)
[ -z "$strangers" ] || fail "the wheel needs $strangers"
ls env/lib/python3*/site-packages/sparselens-"$version".dist-info/licences-of-libraries/libtbb12.txt >/dev/null || fail "no licence of oneTBB"
! readelf -d env/lib/sparselens/libs/* | grep -E 'R(UN)?PATH' | grep -v 'ORIGIN\]' || fail "a library looks for others elsewhere"

# The zip: its add-on finds the tools in it.
python3 -m zipfile -l "$zip" >list
grep -q "sparselens_blender/LICENSE " list || fail "no licence in the zip"
for system in linux windows; do # each has its own tools alone
    [ -e "${zip/linux/$system}" ] || continue
    [ "$(python3 -m zipfile -l "${zip/linux/$system}" | grep -oE 'sparselens_blender/sparselens-[^ ]*')" = \
        "sparselens_blender/$(cd "$made" && ls sparselens-"$version"-$system-x86_64.*)" ] || fail "the tools in ${zip/linux/$system}"
done
if command -v blender >/dev/null; then
    logged env -i HOME="$scratch/home" PATH=/usr/bin:/bin blender -b --python-exit-code 3 --python-expr "import bpy
bpy.ops.preferences.addon_install(filepath='$zip')
bpy.ops.preferences.addon_enable(module='sparselens_blender')
assert bpy.ops.sparselens.find_tools() == {'FINISHED'}"
    grep -q "dof-gather (sparselens) $version, installed: $scratch/home/" log || fail "the add-on of the zip: $(tail -n 5 log)"
else
    echo "skipped: the zip: needs Blender"
fi

# The plug-ins link the libraries of the compilers, and the second that of its host.
mkdir plugins
for file in "$made"/*-openfx-*.tar.xz "$made"/*-openimageio-*.tar.xz; do tar -xJf "$file" -C plugins; done
strangers=$(readelf -d plugins/SparseLens.ofx.bundle/Contents/*/SparseLens.ofx plugins/dof.imageio.so | grep NEEDED |
    grep -vE '\[(lib(c|m|gcc_s|stdc\+\+|OpenImageIO[_a-zA-Z]*)\.so|ld-linux)' || true)
[ -z "$strangers" ] || fail "the plug-ins need $strangers"
if command -v oiiotool >/dev/null; then
    tar -xJf "$archive"
    echo '{"ldi": "l.exr", "quality": "draft"}' >l.dof
    logged env OIIO_LIBRARY_PATH="$PWD/plugins" SPARSELENS_BIN="$PWD/sparselens-$version-linux-x86_64/bin" oiiotool l.dof -o by-plugin.exr
fi
echo "the files are as they should be"

# Sixty seconds of the README without a compiler.
for suite in "${suites[@]}"; do
    root=${SPARSELENS_ROOTS:-/var/tmp/sparselens-roots}/bare-$suite
    "$source_dir/tests/make-root.sh" "$suite" "$root"
    rm -rf "$root/try" && mkdir "$root/try" && cp "$made"/* "$root/try/"
    within() { env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive chroot "$root" bash -euc "cd /try; $1" >log 2>&1 || fail "$suite: $(tail -n 5 log)"; }
    commands=$(readme_block sh README.md | sed -n '/^export PATH/,$p' | sed '1d; s/fence --views/fence --size 96x54 --views/')
    [ "$(wc -l <<<"$commands")" -ge 5 ] || fail "the README has no sixty seconds"
    cp -L /etc/resolv.conf "$root/etc/" 2>/dev/null || true
    mountpoint -q "$root/proc" || mount -t proc proc "$root/proc"
    trap '! mountpoint -q "$root/proc" || umount "$root/proc"; rm -rf "$scratch"' EXIT
    [ -x "$root/usr/bin/xz" ] || within 'apt-get -q update && apt-get -q -y install --no-install-recommends xz-utils'
    within "tar xf sparselens-$version-linux-x86_64.tar.xz; export PATH=\$PWD/sparselens-$version-linux-x86_64/bin:\$PATH; $commands"
    echo "$suite: the archive works"
    [ "$suite" = bookworm ] || { umount "$root/proc" && continue; }
    cp -L /etc/ssl/certs/ca-certificates.crt "$root/etc/" # of this machine's way to the net
    within 'apt-get -q update && apt-get -q -y install --no-install-recommends python3-venv'
    printf '%s\n' "$use_wheel" >"$root/try/use.sh"
    within "export PIP_CERT=/etc/ca-certificates.crt; bash use.sh /try /try/${wheel##*/}"
    echo "$suite: the wheel works"
    within "mkdir packages; apt-get -q -y install --no-install-recommends ./*.deb; cd packages; $commands"
    echo "$suite: the packages work"
    umount "$root/proc"
done
