#!/bin/bash
# Photographs: pictures and depths of PNG, JPEG and TIFF, as estimators leave them, gathered like the same scene as EXR
# with exact depth; what is wrong with them gets one line; video, whose depth may flicker.
. "$(dirname "$0")/check.sh"
command -v oiiotool >/dev/null || skip "needs oiiotool (openimageio-tools)"
unset OCIO
psnr() { oiiotool --fail 1 "$1" "$2" --diff | sed -n 's/ *Peak SNR = //p'; }
within() { awk "BEGIN { exit !($1 > $2 - $3) }" || fail "$4: $1 dB, not $2"; }
silent() { [ ! -s stderr ] || fail "$*: $(cat stderr)"; }

# Three traced scenes, with their nearest and farthest depth. The photograph is a JPEG. Its depth is a disparity of 8 or 16
# bits, its edges soft over three pixels, with noise of one part in 250. 28.8 pixels (R F of 480 pixels) at 320 are 19.2.
size=320x180 least=0.3
while read -r scene near far; do
    mkdir "$scene"
    exits 0 "$bin/dof-trace" "$scene" --size $size --views 0 --spp 64 --reference 128 -o "$scene"
    blur=$(awk "BEGIN { print 19.2 * (1 / $near - 1 / $far) }")
    focus=$(awk "BEGIN { print 1 / (1 + (1 / 5 - 1 / $far) / (1 / $near - 1 / $far)) }")
    oiiotool "$scene/reference.exr" --ch R,G,B --colorconvert linear sRGB -d uint8 -o "$scene/truth.png"
    oiiotool "$scene/center.exr" --ch R,G,B --colorconvert linear sRGB -d uint8 --compression jpeg:95 -o "$scene/photo.jpg"
    oiiotool --pattern constant:color=1 $size 1 "$scene/center.exr" --ch Z --div --subc "$(awk "BEGIN { print 1 / $far }")" \
        --mulc "$(awk "BEGIN { print 1 / (1 / $near - 1 / $far) }")" --clamp:min=0:max=1 --chnames Y -d float -o "$scene/disparity.exr"
    for bits in 8 16; do
        oiiotool "$scene/disparity.exr" --blur:kernel=binomial 3x3 --noise:type=gaussian:stddev=0.004:seed=3 \
            --clamp:min=0:max=1 -d uint$bits -o "$scene/depth$bits.png"
        oiiotool "$scene/disparity.exr" -d uint$bits -o "$scene/exact$bits.png"
        oiiotool --pattern constant:color=1 $size 1 -i:type=float "$scene/exact$bits.png" --addc 1 --div --chnames Z -o "$scene/z.exr"
        oiiotool -i:type=float "$scene/photo.jpg" -d float --colorconvert sRGB linear "$scene/z.exr" --chappend --chnames R,G,B,Z -o "$scene/exact.exr"
        exits 0 "$bin/dof-gather" "$scene/exact.exr" -o "$scene/exact.png" --focal-length 36 --sensor-width 36 --depth z \
            --lens-radius "$(awk "BEGIN { print $blur / 320 }")" --focus-distance "$focus"
        exits 0 "$bin/dof-gather" "$scene/photo.jpg" --depth-file "$scene/depth$bits.png" --disparity --blur "$blur" --grain 0 \
            --focus-distance "$focus" -o "$scene/out$bits.png"
        silent "$scene, $bits bits"
        within "$(psnr "$scene/out$bits.png" "$scene/truth.png")" "$(psnr "$scene/exact.png" "$scene/truth.png")" $least "$scene, $bits bits"
    done
    [ "$(psnr "$scene/photo.jpg" "$scene/truth.png" | cut -d. -f1)" -lt 34 ] || fail "$scene: the photograph is as good"
done <<'END'
plate 3.15 18
planes 2.5 24
mirror 2.77 18
END

# Colours of integers are decoded, floating-point ones are linear; depths that do not lie from 0 to 1 are scaled. So the same
# picture comes from any of these files.
cd plate
photo=("$bin/dof-gather" photo.jpg --depth-file exact16.png --blur 6 --grain 0 --focus-pixel 160,120)
exits 0 "${photo[@]}" -o out.exr
oiiotool -i:type=float photo.jpg -d float --colorconvert sRGB linear -o linear.tif
oiiotool linear.tif -o linear.exr
oiiotool -i:type=float exact16.png --mulc 3 --subc 1 --chnames Y -d float -o depth.exr # scaled to 0 to 1 by its own range
for words in "linear.tif --depth-file exact16.png" "linear.exr --depth-file exact16.png" "linear.exr --depth-file depth.exr --disparity"; do
    # shellcheck disable=SC2086
    exits 0 "$bin/dof-gather" $words --blur 6 --grain 0 --focus-pixel 160,120 -o same.exr
    [[ "$words" = *depth.exr* ]] || silent "$words"
    within "$(psnr same.exr out.exr)" 55 0 "$words" # edges are found in the colours of the file
done
grep -q 'its depth goes from -1 to .*, and is scaled to 0 to 1' stderr || fail "depth.exr is scaled in silence: $(cat stderr)"
picture differ out.exr linear.exr R,G,B 0.05 || fail "nothing is blurred"
exits 0 "$bin/dof-gather" photo.jpg --depth-file exact16.png --blur 6 --focus-pixel 160,120 -o grain.exr
picture differ grain.exr out.exr R,G,B 0.001 || fail "there is no grain"
exits 0 "$bin/dof-gather" photo.jpg --depth-file exact16.png --blur 0 --focus-pixel 160,120 -o sharp.png
oiiotool --fail 0.005 photo.jpg sharp.png --diff >stdout || fail "sharp colours do not come back: $(cat stdout)"

# A smaller depth is fitted to the colours, which is better than to enlarge it.
oiiotool exact8.png --resize:filter=box 80x45 -d uint8 -o quarter.png
oiiotool quarter.png --resize 320x180 -d uint16 -o enlarged.png
exits 0 "${photo[@]}" -o out.png
for depth in quarter enlarged; do
    exits 0 "$bin/dof-gather" photo.jpg --depth-file $depth.png --blur 6 --grain 0 --focus-pixel 160,120 -o by-$depth.png
    silent $depth
done
within "$(psnr by-quarter.png out.png)" "$(psnr by-enlarged.png out.png)" -0.5 "a depth of a quarter"

# Any format will do.
oiiotool exact8.png -o depth.pgm
for depth in exact8.png depth.pgm; do exits 0 "$bin/dof-gather" photo.jpg --depth-file $depth --blur 6 --focus-pixel 160,120 -o ${depth#*.}.exr; done
picture same pgm.exr png.exr R,G,B 5e-4 || fail "depth.pgm: another picture" # depths differ in their last bit

# One line for each mistake.
oiiotool depth8.png --resize 160x90 -o small.png
oiiotool depth8.png --resize 160x99 -o short.png
oiiotool depth8.png --mulc 0 -o even.png
oiiotool depth8.png --invert -o inverted.png
wrong() { fails_saying "$1" "$2" "$bin/dof-gather" photo.jpg -o x.png "${@:3}"; }
sharp=(--focus-pixel 160,120)
wrong 1 'short.png: is 160x99 pixels large, and photo.jpg is 320x180: .*--resize 160x90' --depth-file short.png --blur 6 "${sharp[@]}"
wrong 1 'photo.jpg: has colours, and depth must be grey' --depth-file photo.jpg --blur 6 "${sharp[@]}"
wrong 1 'its depth is the same everywhere' --depth-file even.png --blur 6 "${sharp[@]}"
for file in photo.jpg depth8.png; do head -c $(($(stat -c %s $file) / 2)) $file >half.${file#*.}; done
wrong 1 'half.jpg: cannot read: a part of the file is missing' --depth-file half.jpg --blur 6 "${sharp[@]}"
wrong 1 'half.png: cannot read' --depth-file half.png --blur 6 "${sharp[@]}"
[ "$(wc -l <stderr)" = 1 ] || fail "libpng adds lines of its own: $(cat stderr)"
printf '\x93NUMPY\1\0v\0' >depth.npy
wrong 1 'depth.npy: is a NumPy array: save it as a 16-bit PNG' --depth-file depth.npy --blur 6 "${sharp[@]}"
wrong 1 'none.png: cannot read' --depth-file none.png --blur 6 "${sharp[@]}"
wrong 2 'photo.jpg: is a picture without depth: give its depth by --depth-file' --blur 6 "${sharp[@]}"
wrong 2 'is a photograph, .*\(--blur 2%\)' --depth-file depth8.png --fstop 2 "${sharp[@]}"
for blur in 2%% % -2% 1:2%,3:20; do
    wrong 2 "--blur: must be a number .*, or a share of the picture's width \(e.g. 2%\), not '$blur'" --depth-file depth8.png --blur "$blur"
done
wrong 2 '--depth: is for a --depth-file' --depth inverse
for lens in --fstop --lens-radius --focal-length --sensor-width; do
    wrong 2 "--blur excludes $lens|$lens excludes --blur" --depth-file depth8.png --blur 6 "$lens" 2 "${sharp[@]}"
done
fails_saying 2 '--blur: is for depths that are a disparity' "$bin/dof-gather" center.exr --blur 6 -o x.png
fails_saying 2 '--grain: is for photographs' "$bin/dof-gather" center.exr --grain 1 -o x.png
exits 0 "$bin/dof-gather" photo.jpg -o x.png --depth-file inverted.png --blur 6 "${sharp[@]}"
grep -q 'its depth is darker below than above.*--invert' stderr || fail "inverted: $(cat stderr)"

# Blur is 2 % of the width, the focus is on the nearest large thing near the middle, which one line says, and the quality is
# final, unless other values are given.
exits 0 "$bin/dof-gather" photo.jpg --depth-file depth8.png -o usual.png
[ "$(wc -l <stderr)" = 1 ] && chosen=$(sed -n 's/.*the focus is on pixel \([0-9]*,[0-9]*\), .*; --focus-pixel chooses another$/\1/p' stderr) && [ "$chosen" ] ||
    fail "the usual focus: $(cat stderr)"
for words in "--blur 2%" "--blur 6.4 --quality final"; do
    # shellcheck disable=SC2086
    exits 0 "$bin/dof-gather" photo.jpg --depth-file depth8.png $words --focus-pixel "$chosen" -o same.png
    silent "$words"
    cmp -s usual.png same.png || fail "$words: another picture than by default"
done
exits 0 "$bin/dof-gather" photo.jpg --depth-file depth8.png --quality normal --focus-pixel "$chosen" -o normal.png
cmp -s usual.png normal.png && fail "--quality normal is final quality"

# A depth in the photograph, as each phone writes it, is that of a file. One that is given comes first.
oiiotool depth16.png --invert -o black.png
oiiotool depth8.png --compression jpeg:100 -o depth.jpg
own() { python3 -B "$source_dir/tests/equal/own_depth.py" "$@" || fail "own_depth.py $*"; }
for kind in gdepth elements dynamic apple; do
    depth=black.png && [ $kind = apple ] && depth=depth.jpg
    own $kind photo.jpg $depth own-$kind.jpg
    exits 0 "$bin/dof-gather" own-$kind.jpg --grain 0 -o own.png
    [ "$(wc -l <stderr)" = 1 ] || fail "$kind: $(cat stderr)"
    exits 0 "$bin/dof-gather" photo.jpg --depth-file "${depth/black.png/depth16.png}" --grain 0 -o same.png
    cmp -s own.png same.png || fail "$kind: another picture than with the same depth in a file"
    exits 0 "$bin/dof-gather" own-$kind.jpg --depth-file inverted.png --blur 6 "${sharp[@]}" -o own.exr
    exits 0 "$bin/dof-gather" photo.jpg --depth-file inverted.png --blur 6 "${sharp[@]}" -o same.exr
    picture same own.exr same.exr R,G,B 0 || fail "$kind: --depth-file does not come first"
done
oiiotool photo.jpg -o photo.ppm
oiiotool depth8.png -o depth.pgm
for ending in heic avif; do
    if ! python3 -B "$source_dir/tests/equal/heif.py" own.$ending photo.ppm depth.pgm 2>stderr; then
        grep -q 'encoder is missing' stderr || fail "heif.py: $(cat stderr)"
        echo "skipped: $ending, which libheif cannot write here"
        continue
    fi
    exits 0 "$bin/dof-gather" own.$ending -o own.png
    [ "$(wc -l <stderr)" = 1 ] || fail "$ending: $(cat stderr)"
    exits 0 "$bin/dof-gather" photo.jpg --depth-file depth8.png -o same.png
    within "$(psnr own.png same.png)" 45 0 "$ending: its own depth"
    python3 -B "$source_dir/tests/equal/heif.py" plain.$ending photo.ppm
    fails_saying 2 "plain.$ending: is a picture without depth" "$bin/dof-gather" plain.$ending -o x.png
    head -c 20000 own.$ending >cut.$ending
    fails_saying 1 "cut.$ending: cannot read: " "$bin/dof-gather" cut.$ending -o x.png
done
broken() { # broken SAYS DEPTH: one line
    own dynamic photo.jpg "$2" broken.jpg
    fails_saying 1 "broken.jpg: its own depth cannot be used: $1; give another one by --depth-file" "$bin/dof-gather" broken.jpg -o x.png
    [ "$(wc -l <stderr)" = 1 ] || fail "$2: $(cat stderr)"
}
oiiotool black.png --resize 160x180 -o narrow.png
head -c 3000 black.png >cut.png
python3 -c 'import struct, sys, zlib
head = b"IHDR" + struct.pack(">2I5B", 60000, 60000, 8, 0, 0, 0, 0)
sys.stdout.buffer.write(b"\x89PNG\r\n\x1a\n\0\0\0\r" + head + struct.pack(">I", zlib.crc32(head)) + b"\0\0\0\0IDAT" + bytes(8))' >huge.png
broken 'it has 160x180 pixels, another shape than the picture with 320x180' narrow.png
broken 'cannot read: .*' cut.png
broken '.*memory.*' huge.png
broken 'it has colours' photo.jpg
broken 'it is neither a PNG nor a JPEG' depth.npy

# Video: a depth that is estimated anew for each frame flickers, and the warning says by how many pixels of blur.
for frame in 1 2 3; do cp photo.jpg shot.000$frame.jpg && cp depth16.png d.000$frame.png; done
oiiotool depth16.png --mulc 0.8 --addc 0.1 -d uint16 -o d.0003.png
exits 0 "$bin/dof-gather" shot.####.jpg --depth-file d.####.png --frames 1-3 --blur 1:2%,3:6% "${sharp[@]}" -o v.####.png
[ "$(grep -c 'flickers: .* by [0-9.]* pixels or more' stderr)" = 1 ] && grep -q 'shot.0003.jpg: its depth flickers' stderr || fail "flicker: $(cat stderr)"

# Disparities of video that are not between 0 and 1 have one range: what stands still stays as it is.
for frame in 1 2 3; do
    oiiotool -i:type=float exact16.png --mulc 6 --addc 2 --fill:color=$((8 * frame)) 41x41+20+100 --chnames Y -d float -o y.000$frame.exr
done
exits 0 "$bin/dof-gather" shot.####.jpg --depth-file y.####.exr --disparity --frames 1-3 --blur 6 --grain 0 "${sharp[@]}" -o y.####.png
grep -q flickers stderr && fail "steady disparities flicker: $(cat stderr)"
for frame in 1 3; do oiiotool y.000$frame.png --cut 100x60+220+20 -o part$frame.png; done
oiiotool --fail 0 part1.png part3.png --diff >stdout || fail "what stands still changes: $(cat stdout)"

# dof-view has the usual blur and focus unless they are given, and its page sets the blur.
cd ..
export PYTHONDONTWRITEBYTECODE=1
blurs() { # blurs BLUR COMMAND...: the blur that the page begins with, and the largest CoC, which is what it sets.
    exits 0 python3 -c 'import sys; sys.path.insert(0, sys.argv[1]); from served import served
with served(*sys.argv[3:]) as server:
    cocs = [server.picture(settings={"blur": blur})[0]["lens"]["largest_coc"] for blur in ("4", "8")]
    assert server.send("/rendered", b"{\"page\": \"a\"}")[0] == 200
    assert server.said("/facts")["blur"] == float(sys.argv[2]) and abs(cocs[1] / cocs[0] - 2) < 0.01, cocs' \
        "$source_dir/tests/viewing" "$@" || fail "dof-view: $(cat stderr)"
}
blurs 6.4 "$bin/dof-view" plate/own-gdepth.jpg
blurs 5 "$bin/dof-view" plate/photo.jpg --depth-file plate/depth8.png --disparity --blur 5 --grain 0 --focus-pixel 160,120 || fail "--blur"
