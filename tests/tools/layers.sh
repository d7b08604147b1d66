#!/bin/bash
# Files by other renderers: the beauty in a layer, several pictures in one file, parts with different data windows.
. "$(dirname "$0")/check.sh"
command -v oiiotool >/dev/null || skip "needs oiiotool (openimageio-tools)"
gather=$bin/dof-gather
lens=(--focal-length 50 --sensor-width 36 --lens-radius 0.1 --focus-distance 2)
same() { picture same "$1" "$2" >found 2>&1 || fail "$3 ($(cat found))"; }

# A multilayer file gives the same picture as plain channel names, and reports which layer it used.
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

# Two pictures in one file, as Blender writes two view layers: each uses its own depth, and one must be chosen.
near=(Z=1.5 B=0.9)
for name in fg bg; do
    colours=(R=0.1 G=0.5)
    [ $name = fg ] || colours=(R=0.8 G=0.2)
    picture make $name.exr 24x16 "${colours[@]}" B=0.2 A=1 Z=4 fill=8x8+8+4 "${near[@]}"
    oiiotool $name.exr --ch R,G,B,A,Z --chnames $name.Combined.R,$name.Combined.G,$name.Combined.B,$name.Combined.A,$name.Depth.Z -o named.$name.exr
    near=(Z=9 R=0)
done
oiiotool named.bg.exr named.fg.exr --chappend -o two.exr
for tool in dof-gather ldi-warp ldi-cluster ldi-plan; do
    fails_saying 2 'two.exr: holds several pictures, bg.Combined and fg.Combined: give --layer with one of bg, fg' \
        "$bin/$tool" two.exr -o x.exr "${lens[@]}"
    fails_saying 2 'holds several pictures' "$bin/$tool" two.exr -o x.exr "${lens[@]}" --depth-channel fg.Depth.Z
    fails_saying 1 "two.exr: has no layer 'hero' .*: its layers are bg, fg" "$bin/$tool" two.exr -o x.exr "${lens[@]}" --layer hero
done
for name in fg bg; do
    picture edit $name.exr one.exr channels=R,G,B,A,Z
    exits 0 "$gather" one.exr -o expected.$name.exr "${lens[@]}"
    exits 0 "$bin/dof-gather" two.exr -o out.exr "${lens[@]}" --layer $name -v
    same out.exr expected.$name.exr "dof-gather --layer $name"
    grep -q "two.exr: depth: $name.Depth.Z" stderr || fail "--layer $name: $(cat stderr)"
    exits 0 "$bin/ldi-warp" one.exr -o expected.ldi.exr
    exits 0 "$bin/ldi-warp" two.exr -o out.ldi.exr --layer $name
    same out.ldi.exr expected.ldi.exr "ldi-warp --layer $name"
    exits 0 "$bin/ldi-cluster" two.exr -o less.exr --layers 1 --layer $name
    exits 0 "$gather" less.exr -o out.exr "${lens[@]}"
    same out.exr expected.$name.exr "ldi-cluster --layer $name"
    exits 0 "$bin/ldi-plan" one.exr "${lens[@]}" --noise 0 -o expected.json
    exits 0 "$bin/ldi-plan" two.exr "${lens[@]}" --noise 0 -o out.json --layer $name
    diff <(grep -v '"center"' expected.json) <(grep -v '"center"' out.json) >differ || fail "ldi-plan --layer: $(cat differ)"
    lab || continue
    exits 0 "$bin/dof-accumulate" --view 0,0 one.exr -o expected.mean.exr --lens-radius 0
    exits 0 "$bin/dof-accumulate" --view 0,0 two.exr -o out.exr --lens-radius 0 --layer $name
    picture same out.exr expected.mean.exr R,G,B,A || fail "dof-accumulate --layer"
done
picture differ expected.fg.exr expected.bg.exr || fail "the two pictures are one"
for name in fg bg; do
    exits 0 "$bin/dof-compare" two.exr two.exr --json --layer $name
    grep -q '"psnr": null' stdout || fail "dof-compare --layer $name: $(cat stdout)"
done
fails_saying 2 'holds several pictures' "$bin/dof-compare" two.exr two.exr
# --layer all: one run for each layer, the same as naming it; %L is its name.
exits 0 "$gather" two.exr -o 'each.%L.exr' "${lens[@]}" --layer all
for name in fg bg; do same each.$name.exr expected.$name.exr "--layer all, $name"; done
exits 0 "$bin/ldi-warp" two.exr -o 'each.%L.ldi.exr' --layer all
for name in fg bg; do
    exits 0 "$gather" each.$name.ldi.exr -o out.exr "${lens[@]}"
    same out.exr expected.$name.exr "ldi-warp --layer all, $name"
done
fails_saying 2 'put %L' "$gather" two.exr -o x.exr "${lens[@]}" --layer all
fails_saying 1 'plain.exr: it has one picture' "$gather" plain.exr -o 'x.%L.exr' "${lens[@]}" --layer=all

# If no layer has such a name, there is a warning; the error about depth lists the channels.
picture edit plain.exr diffuse.exr channels=diffuse.R=R,diffuse.G=G,diffuse.B=B,diffuse.A=A,Z
exits 0 "$gather" diffuse.exr -o out.exr "${lens[@]}"
grep -q 'warning: diffuse.exr: no layer is named as the beauty.*its layers are diffuse:' stderr || fail "no warning: $(cat stderr)"
exits 0 "$gather" plain.exr -o expected.exr "${lens[@]}"
exits 0 "$gather" diffuse.exr -o out.exr "${lens[@]}" --layer diffuse
same out.exr expected.exr "--layer of a layer that no renderer calls the beauty"
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

# Object numbers are ids if the layer's name says so: no pixel holds a mean of two. -v says what happens to each layer.
picture make ids.exr 48x32 R=0.2 G=0.5 B=0.1 A=1 Z=1.5 ViewLayer.IndexOB.X=1 ViewLayer.Vector.X=1 fill=16x16+16+8 Z=9 ViewLayer.IndexOB.X=2 ViewLayer.Vector.X=2
exits 0 "$bin/ldi-warp" ids.exr -o ids.ldi.exr
for input in ids.exr ids.ldi.exr; do
    exits 0 "$gather" $input -o out.exr "${lens[@]}" -v
    [ "$(oiiotool out.exr --ch ViewLayer.IndexOB.X --colorcount:eps=0 1:2 -o x.exr | awk '{ n += $1 } END { print n }')" = 1536 ] ||
        fail "$input: ids are averaged: $(oiiotool out.exr --ch ViewLayer.IndexOB.X --colorcount:eps=0 1:2)"
    [ "$(oiiotool out.exr --ch ViewLayer.Vector.X --colorcount:eps=0 1:2 -o x.exr | awk '{ n += $1 } END { print n }')" -lt 1500 ] ||
        fail "$input: other data is not averaged"
    for said in 'of the picture: light' 'ViewLayer.IndexOB: ids: those of the front sample' 'ViewLayer.Vector: data: averaged'; do
        grep -q "dof-gather: $input: layer $said" stderr || fail "-v: $said ($(cat stderr))"
    done
done
