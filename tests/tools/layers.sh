#!/bin/bash
# Files as other renderers write them: the beauty in a layer, parts of different data windows.
. "$(dirname "$0")/check.sh"
command -v oiiotool >/dev/null || skip "needs oiiotool (openimageio-tools)"
gather=$bin/dof-gather
lens=(--focal-length 50 --sensor-width 36 --lens-radius 0.1 --focus-distance 2)
same() { picture same "$1" "$2" >found 2>&1 || fail "$3 ($(cat found))"; }

# A multilayer file gives the picture of the same channels under plain names, and says what it took.
oiiotool --pattern fill:topleft=0.1,0.5,0.2,0.5,1:bottomright=0.9,0.2,0.1,1,4 24x16 5 --chnames R,G,B,A,Z -d float -o plain.exr
oiiotool plain.exr --chnames ViewLayer.Combined.R,ViewLayer.Combined.G,ViewLayer.Combined.B,ViewLayer.Combined.A,ViewLayer.Depth.Z \
    -o blender.exr
exits 0 "$gather" plain.exr -o expected.exr "${lens[@]}"
exits 0 "$gather" blender.exr -o out.exr "${lens[@]}" -v
same out.exr expected.exr "ViewLayer.Combined is the beauty"
grep -q 'blender.exr: beauty: ViewLayer.Combined.R, .*; coverage: ViewLayer.Combined.A$' stderr || fail "beauty: $(cat stderr)"
grep -q 'blender.exr: depth: ViewLayer.Depth.Z$' stderr || fail "depth: $(cat stderr)"
exits 0 "$bin/ldi-warp" plain.exr -o expected.ldi.exr
exits 0 "$bin/ldi-warp" blender.exr -o out.ldi.exr -v
grep -q 'coverage: ViewLayer.Combined.A$' stderr || fail "ldi-warp -v: $(cat stderr)"
same out.ldi.exr expected.ldi.exr "ldi-warp takes another beauty"
exits 0 "$gather" blender.exr -o out.png "${lens[@]}"

# Layers of which none has such a name are a warning; the error about depth lists the channels.
picture edit plain.exr diffuse.exr channels=diffuse.R=R,diffuse.G=G,diffuse.B=B,diffuse.A=A,Z
exits 0 "$gather" diffuse.exr -o out.exr "${lens[@]}"
grep -q 'warning: diffuse.exr: no layer is named as the beauty.*its layers are diffuse:' stderr || fail "no warning: $(cat stderr)"
oiiotool plain.exr --chnames R,G,B,A,far -o far.exr
fails_saying 1 'far.exr: has no depth channel.*--depth-channel; its channels are R, G, B, A, far' \
    "$gather" far.exr -o x.exr "${lens[@]}"

# A depth part over the whole picture beside a cropped colour part.
oiiotool plain.exr --ch R,G,B,A --crop 12x8+6+4 --attrib oiio:subimagename rgba -o colour.exr
oiiotool plain.exr --ch Z --attrib oiio:subimagename depth -o depth.exr
oiiotool colour.exr depth.exr --siappend -o parts.exr
oiiotool plain.exr --ch R,G,B,A --crop 12x8+6+4 --crop 24x16+0+0 -o cropped.exr
oiiotool cropped.exr depth.exr --chappend -o united.exr
exits 0 "$gather" united.exr -o expected.exr "${lens[@]}"
exits 0 "$gather" parts.exr -o out.exr "${lens[@]}"
same out.exr expected.exr "parts of two data windows"
