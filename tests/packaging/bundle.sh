#!/bin/bash
# The archive of tools/bundle.sh, used from a folder with blanks in its name: its tools make the files that the build
# makes, without anything of the system but a shell, and where root may, in a root that has nothing else at all.
#   bash bundle.sh BIN_DIR BUILD_DIR
. "$(dirname "$0")/../tools/check.sh"
build=$2
command -v oiiotool >/dev/null || skip "needs oiiotool (openimageio-tools)"
fails_saying 1 'is not a build folder' "$source_dir/tools/bundle.sh" "$scratch"

mkdir "my tools"
exits 0 "$source_dir/tools/bundle.sh" "$build" "my tools" unpacked
made=$(echo "my tools"/sparselens-*-linux-x86_64)
[ "$(du -s --apparent-size -B1 "$made" | cut -f1)" -le 120000000 ] || fail "too large: $(cat stdout)"
if find "$made" | grep -iE 'avcodec|opencv|python3|libasan|/(dof-report|dof-accumulate)'; then fail "that does not belong there"; fi
for name in sparselens libc6 libstdc++6 "$(dpkg-query -S /usr/include/boost/beast.hpp | sed "s/:.*//")" nlohmann-json3-dev README common-licenses/LGPL-2.1; do
    [ -s "$made/licences/$name.txt" ] || [ -s "$made/licences/$name" ] || fail "no licence of $name"
done
while read -r library; do
    grep -q "^$(dpkg-query -S "*/${library##*/}" | sed '/^diversion by /d; /-cross: /d; /: .*\/libx*32\//d' | sed -n '1s/:.*//p') " "$made/licences/README.txt" || fail "no licence of $library"
done < <(find "$made/lib" -maxdepth 1 -name '*.so*')

# The files are the build's, also by a link on the PATH and in another folder.
mkdir theirs ours links
ln -s "../$made/bin/dof-gather" links/gather-of-the-archive
for tool in dof-trace ldi-warp ldi-cluster dof-gather dof-compare dof-finish dof-view ldi-plan; do
    exits 0 env -i PATH= "$made/bin/$tool" --version
    [ "$(cat stdout)" = "$("$bin/$tool" --version)" ] || fail "$tool --version says $(cat stdout)"
done
sixty_seconds() { # BIN_DIR FOLDER
    exits 0 env -i SPARSELENS_NO_HISTORY=1 PATH="$1:/usr/bin:/bin" bash -euc "cd '$2'
        dof-trace fence --size 96x54 --views 2 --spp 4 -o views
        ldi-warp views/center.exr views/view_*.exr -o - | ldi-cluster - -o fence.ldi.exr
        dof-gather fence.ldi.exr -o picture.exr
        dof-gather fence.ldi.exr --focus-distance 2.2 -o picture.png"
}
sixty_seconds "$bin" theirs
sixty_seconds "$scratch/$made/bin" ours
for file in views/center.exr views/view_1.exr fence.ldi.exr picture.exr; do
    cmp "theirs/$file" "ours/$file" || fail "the archive makes another $file"
done
exits 0 links/gather-of-the-archive theirs/fence.ldi.exr -o linked.exr
cmp linked.exr theirs/picture.exr || fail "by a link: another picture"
for ending in jpg tga; do
    fails_saying 2 'ends in no format that is written: .exr, .png \(see' "$made/bin/dof-gather" theirs/fence.ldi.exr -o x.$ending
done

# The pixels of PNG are those that OpenImageIO writes, also with coverage and pixels that are not square.
oiiotool --pattern fill:topleft=-0.1,0.5,1.9,1,3:bottomright=0.9,0.2,0.1,0.4,3 37x23 5 --chnames R,G,B,A,Z -d float --attrib:type=float PixelAspectRatio 1.5 -o half.exr
for of in theirs:"$bin" ours:"$made/bin"; do
    exits 0 "${of#*:}/dof-gather" half.exr --focal-length 50 --sensor-width 36 --fstop 8 --focus-distance 3 -o "${of%%:*}/half.png"
done
for name in picture half; do
    oiiotool theirs/$name.png ours/$name.png --diff >log 2>&1 || fail "other pixels in $name.png: $(cat log)"
    for of in theirs ours; do
        oiiotool --info -v $of/$name.png | grep -E 'channel list|PixelAspect|uint|Unassoc' | sed 's/^[^:]*: *//; /^1$/d' >$of.info
    done
    cmp theirs.info ours.info || fail "$name.png: $(cat ours.info), not $(cat theirs.info)"
done

# So are those that it reads of photographs and their depth, also turned as a camera says; others are named.
oiiotool --pattern fill:topleft=0.1,0.5,0.9:bottomright=0.9,0.2,0.1 61x37 3 --noise --attrib Orientation 6 -d uint8 -o photo.jpg \
    -o photo.tif --ch R -d uint16 --rotate90 --attrib Orientation 1 -o depth.png
for of in theirs:"$bin" ours:"$made/bin"; do
    exits 0 "${of#*:}/dof-gather" photo.jpg --depth-file depth.png --blur 5 --focus-pixel 8,9 -o "${of%%:*}/photo.exr"
done
oiiotool theirs/photo.exr ours/photo.exr --fail 1e-3 --diff >log 2>&1 || fail "another picture of a photograph: $(cat log)"
fails_saying 1 'photo.tif: cannot read: this archive reads PNG, JPEG and HEIC: convert it' "$made/bin/dof-gather" photo.tif --depth-file depth.png --blur 5 --focus-pixel 8,9 -o x.exr

# What does not fit replaces nothing.
exits 0 cp ours/picture.png whole.png
fails_saying 1 'ours/picture.png: cannot write: File too large' bash -c 'ulimit -f 1; exec "$@"' - "$made/bin/dof-gather" theirs/fence.ldi.exr --focus-distance 2.2 -o ours/picture.png
cmp whole.png ours/picture.png || fail "a picture that is cut off replaces a good one"

# The full disk is said.
if [ -w /dev/full ]; then
    fails_saying 1 '/dev/full' "$made/bin/dof-gather" half.exr --focal-length 50 --sensor-width 36 --fstop 8 --focus-distance 3 -o /dev/full
fi

# An empty root: the loader of the archive is the only program that the system starts.
if [ "$(id -u)" -eq 0 ] && chroot / true 2>/dev/null; then
    mkdir -p "empty/my tools"
    mv "$made" "empty/my tools/"
    cp theirs/fence.ldi.exr empty/
    root="/my tools/$(basename "$made")"
    exits 0 env -i SPARSELENS_NO_HISTORY=1 "$(command -v chroot)" empty "$root/lib/ld-linux-x86-64.so.2" --library-path "$root/lib" \
        "$root/libexec/dof-gather" fence.ldi.exr -o picture.exr
    cmp empty/picture.exr theirs/picture.exr || fail "in an empty root: another picture"
    echo "in an empty root: the same picture"
else
    echo "skipped: the archive in an empty root: only root may change it"
fi
