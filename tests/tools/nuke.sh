#!/bin/bash
# Files by Nuke and other programs: colours and depths with other names, unpremultiplied colours, depth in a separate
# file, white near; and output names without a known format.
. "$(dirname "$0")/check.sh"
gather=$bin/dof-gather warp=$bin/ldi-warp cluster=$bin/ldi-cluster
lens=(--focal-length 50 --sensor-width 36 --lens-radius 0.1 --focus-distance 6)
same() { picture same "$@" >found 2>&1 || fail "$1 and $2 differ ($(cat found))"; }
has_channels() { # FILE NAMES: these and no others
    picture edit "$1" listed.exr channels="$2" || fail "$1 lacks one of $2"
    picture same "$1" listed.exr >found || fail "$1 has other channels than $2 ($(cat found))"
}

# A surface with soft edges at 2 before nothing, and a pass.
picture make plain.exr 48x32 R=0 G=0 B=0 A=0 diffuse.R=0 diffuse.G=0 diffuse.B=0 Z=inf \
    fill=24x16+12+8 R=noise:1 G=noise:2 B=noise:3 A=0.5 diffuse.R=noise:4 diffuse.G=noise:5 diffuse.B=noise:6 Z=2 \
    R*=0.5 G*=0.5 B*=0.5 fill=20x12+14+10 A=1 R*=2 G*=2 B*=2
layer=diffuse.R,diffuse.G,diffuse.B
exits 0 "$bin/dof-gather" plain.exr -o expected.exr "${lens[@]}"
exits 0 "$bin/ldi-cluster" plain.exr -o expected.deep.exr --tolerance 0
exits 0 "$bin/ldi-warp" plain.exr -o expected.ldi.exr

# Colours with other names are treated as R, G, B and A, coverage is not treated as light, and files keep the names.
for names in red,green,blue,alpha r,g,b,a RED,Green,blue,Alpha rgba.red,rgba.green,rgba.blue,rgba.alpha Ci.r,Ci.g,Ci.b,Ci.a \
    beauty.red,beauty.green,beauty.blue,beauty.alpha; do
    IFS=, read -r r g b a <<<"$names"
    picture edit plain.exr named.exr channels="$r=R,$g=G,$b=B,$a=A,diffuse.red=diffuse.R,diffuse.Green=diffuse.G,diffuse.b=diffuse.B,depth.Z=Z"
    back="R=$r,G=$g,B=$b,A=$a,diffuse.R=diffuse.red,diffuse.G=diffuse.Green,diffuse.B=diffuse.b"
    kept="$names,diffuse.red,diffuse.Green,diffuse.b"
    exits 0 "$bin/dof-gather" named.exr -o out.exr "${lens[@]}"
    [ ! -s stderr ] || fail "$names: $(cat stderr)"
    has_channels out.exr "$kept"
    picture edit out.exr back.exr channels="$back"
    same back.exr expected.exr R,G,B,A,$layer
    exits 0 "$bin/dof-gather" named.exr -o out.exr "${lens[@]}" --channels rgba
    has_channels out.exr "$names"
    exits 0 "$bin/dof-gather" named.exr -o out.exr "${lens[@]}" --channels diffuse.red
    has_channels out.exr diffuse.red
    for made in "$cluster --tolerance 0" "$bin/ldi-warp"; do
        # shellcheck disable=SC2086
        exits 0 $made named.exr -o deep.exr
        exits 0 "$bin/dof-gather" deep.exr -o out.exr "${lens[@]}"
        has_channels out.exr "$kept"
        picture edit out.exr back.exr channels="$back"
        same back.exr expected.exr R,G,B,A,$layer
    done
    exits 0 "$bin/dof-compare" named.exr plain.exr --json
    grep -q '"psnr": null' stdout || fail "dof-compare of $names: $(cat stdout)"
done

# Depth with the usual names in any case; a guess is reported.
without_depth=R,G,B,A,$layer
for name in Depth.Z Z.R depth.V zDepth.R depth.z z DEPTH.Z zdepth; do
    picture edit plain.exr named.exr channels="$without_depth,$name=Z"
    exits 0 "$bin/dof-gather" named.exr -o out.exr "${lens[@]}"
    [ ! -s stderr ] || fail "$name: $(cat stderr)"
    same out.exr expected.exr $without_depth
done
for name in a_long_name.Z my_depth_pass cameraDepth.V; do
    picture edit plain.exr named.exr channels="$without_depth,$name=Z"
    exits 0 "$bin/dof-gather" named.exr -o out.exr "${lens[@]}"
    [ "$(grep -c "warning: named.exr: channel $name is taken for the depth; .*--depth-channel" stderr)" = 1 ] || fail "$name: $(cat stderr)"
    same out.exr expected.exr $without_depth
done
picture edit plain.exr two.exr channels="$without_depth,a_depth=Z,b_depth=Z"
fails_saying 1 'two.exr: has no depth channel' "$bin/dof-gather" two.exr -o x.exr "${lens[@]}"
picture edit plain.exr normal.exr channels="$without_depth,N.X=Z,N.Y=Z,N.Z=Z"
fails_saying 1 'normal.exr: has no depth channel' "$bin/dof-gather" normal.exr -o x.exr "${lens[@]}"

# Depth in a separate file, with any name; for several pictures one file each.
picture edit plain.exr beauty.exr channels=$without_depth
picture edit plain.exr depth.0001.exr channels=depth.Z=Z
picture edit plain.exr luma.exr channels=Y=Z
picture edit plain.exr grey.exr channels=R=Z,G=Z,B=Z
for file in depth.0001.exr luma.exr grey.exr; do
    exits 0 "$bin/dof-gather" beauty.exr --depth-file $file -o out.exr "${lens[@]}" -v
    grep -q "depth: .* of $file" stderr || fail "--depth-file $file: $(cat stderr)"
    same out.exr expected.exr $without_depth
done
picture edit plain.exr wrong.exr Z=1
exits 0 "$bin/dof-gather" wrong.exr --depth-file depth.0001.exr -o out.exr "${lens[@]}"
same out.exr expected.exr $without_depth
cp beauty.exr beauty.0001.exr
exits 0 "$bin/dof-gather" beauty.####.exr --depth-file depth.####.exr --frames 1 -o out.####.exr "${lens[@]}"
same out.0001.exr expected.exr $without_depth
exits 0 "$bin/ldi-warp" beauty.exr --depth-file luma.exr -o out.ldi.exr
same out.ldi.exr expected.ldi.exr
exits 0 "$bin/ldi-warp" plain.exr --view 0.1,0 plain.exr -o two.ldi.exr "${lens[@]}"
exits 0 "$bin/ldi-warp" beauty.exr --view 0.1,0 beauty.exr --depth-file luma.exr --depth-file grey.exr -o out.ldi.exr "${lens[@]}"
same out.ldi.exr two.ldi.exr
fails_saying 2 '--depth-file: there are 1 of them for 2 pictures' "$bin/ldi-warp" beauty.exr beauty.exr --depth-file luma.exr -o x.exr
exits 0 "$bin/ldi-cluster" beauty.exr --depth-file luma.exr -o out.deep.exr --tolerance 0
same out.deep.exr expected.deep.exr
exits 0 "$bin/ldi-plan" beauty.exr --depth-file luma.exr "${lens[@]}" --noise 0 -o plan.json
fails_saying 2 '--depth-file: goes with flat pictures, and expected.deep.exr is deep' "$bin/dof-gather" expected.deep.exr --depth-file luma.exr -o x.exr "${lens[@]}"
picture make small.exr 24x16 Z=2
fails_saying 1 'small.exr: its display window .* is not that of beauty.exr' "$bin/dof-gather" beauty.exr --depth-file small.exr -o x.exr "${lens[@]}"
fails_saying 1 'beauty.exr: has no depth channel .*--depth-file' "$bin/dof-gather" beauty.exr -o x.exr "${lens[@]}"
fails_saying 1 'luma.exr: has depth but no colours' "$bin/dof-gather" luma.exr --depth-channel Y -o x.exr "${lens[@]}"

# Flat pictures and views show that their colours are unpremultiplied, and are converted. Light without coverage is not
# mistaken for that.
picture make soft.exr 48x48 R=0 G=0 B=0 A=0 Z=inf fill=32x32+8+8 R=0.1 G=0.2 B=0.05 A=0.25 Z=2 fill=30x30+9+9 R*=2 G*=2 B*=2 A=0.5 \
    fill=28x28+10+10 R*=2 G*=2 B*=2 A=1
picture edit soft.exr straight.exr fill=32x32+8+8 R=0.4 G=0.8 B=0.2
picture edit soft.exr glow.exr R=0.4 G=0.8 B=0.2
exits 0 "$bin/dof-gather" soft.exr -o expected.soft.exr "${lens[@]}"
[ ! -s stderr ] || fail "premultiplied colours: $(cat stderr)"
exits 0 "$bin/dof-gather" glow.exr -o x.exr "${lens[@]}"
[ ! -s stderr ] || fail "a glow: $(cat stderr)"
for tool in dof-gather ldi-warp ldi-plan; do
    exits 0 "$bin/$tool" straight.exr -o x.exr "${lens[@]}"
    [ "$(grep -c "^$tool: warning: straight.exr: .* unpremultiplied: .*--unpremultiplied" stderr)" = 1 ] || fail "$tool: $(cat stderr)"
done
exits 0 "$bin/dof-gather" straight.exr --unpremultiplied -o out.exr "${lens[@]}"
[ ! -s stderr ] || fail "--unpremultiplied: $(cat stderr)"
same out.exr expected.soft.exr 1e-3
exits 0 "$bin/ldi-cluster" soft.exr --tolerance 0 -o soft.deep.exr
exits 0 "$bin/ldi-cluster" straight.exr --unpremultiplied --tolerance 0 -o out.deep.exr
same out.deep.exr soft.deep.exr 1e-3
exits 0 "$bin/ldi-cluster" straight.exr --tolerance 0 -o straight.deep.exr
exits 0 "$bin/dof-gather" straight.deep.exr --unpremultiplied -o out.exr "${lens[@]}"
same out.exr expected.soft.exr 1e-3
exits 0 "$bin/ldi-warp" straight.exr --unpremultiplied -o out.ldi.exr
exits 0 "$bin/ldi-warp" soft.exr -o soft.ldi.exr
same out.ldi.exr soft.ldi.exr 1e-3

# Depth that is 1 near and 0 far: 0 at --near, which is then the larger value.
picture make floor.exr 48x96 R=0.5 G=0.5 B=0.5 A=1 Z=2
picture edit floor.exr white.exr Z=0.875
exits 0 "$bin/dof-gather" white.exr -o x.exr --lens-radius 0 --depth-out z.exr --depth normalized --near 17 --far 1
picture edit floor.exr expected.z.exr channels=Z Z=3
same z.exr expected.z.exr Z 1e-4
picture edit floor.exr black.exr Z=0
exits 0 "$bin/dof-gather" black.exr -o x.exr --lens-radius 0 --depth-out z.exr --depth normalized --near 17 --far 1
picture edit floor.exr expected.z.exr channels=Z Z=inf
same z.exr expected.z.exr Z
picture edit floor.exr reversed.exr Z=0.25
exits 0 "$bin/dof-gather" reversed.exr -o x.exr --lens-radius 0 --depth-out z.exr --depth hyperbolic --near inf --far 0.5
picture edit floor.exr expected.z.exr channels=Z Z=2
same z.exr expected.z.exr Z 1e-4
fails_saying 2 '--depth normalized: --near and --far must be above 0 and not the same' "$bin/dof-gather" white.exr -o x.exr "${lens[@]}" --depth normalized --near 2 --far 2

# --tolerance 0 needs no lens, as the example in the help shows.
picture edit plain.exr behind.exr Z*=2
exits 0 "$bin/ldi-cluster" plain.exr behind.exr -o x.exr --tolerance 0
fails_saying 2 'is unknown: give --' "$bin/ldi-cluster" plain.exr -o x.exr --tolerance 0.1

# An output without a known format is refused before anything is read, with a list of the formats.
for name in shot.psd shot.mov shot.pgn shot; do
    fails_saying 2 "$name ends in no format that is written: .exr, .png" "$bin/dof-gather" missing.exr -o $name "${lens[@]}"
    fails_saying 2 "$name does not end in .exr" "$bin/ldi-warp" missing.exr -o $name
    fails_saying 2 "$name does not end in .exr" "$bin/ldi-cluster" missing.exr -o $name --tolerance 0
    [ ! -e $name ] || fail "$name was written"
done
fails_saying 2 'x.png does not end in .exr' "$bin/ldi-warp" plain.exr -o x.png
fails_saying 2 'z.png does not end in .exr' "$bin/dof-gather" plain.exr -o x.exr --depth-out z.png "${lens[@]}"
exits 0 "$bin/dof-gather" plain.exr -o /dev/null "${lens[@]}"
exits 0 "$bin/dof-gather" plain.exr -o OUT.EXR "${lens[@]}"

# Tiles.
exits 0 "$bin/dof-gather" plain.exr -o tiled.exr --tiles 16 "${lens[@]}"
same tiled.exr expected.exr
[ "$(od -An -tu1 -j5 -N1 tiled.exr | tr -d ' ')" = 2 ] || fail "not in tiles" # the second byte of the version: tiles
exits 0 "$bin/dof-gather" tiled.exr --depth-file plain.exr -o out.exr --lens-radius 0
[ "$(od -An -tu1 -j5 -N1 out.exr | tr -d ' ')" = 0 ] || fail "tiles unasked"
fails_saying 2 '--tiles applies to EXR' "$bin/dof-gather" plain.exr -o x.png --tiles 16 "${lens[@]}"

# Missing values are named.
fails_saying 2 "--focus-distance 1:3,5:6 is keyed by frame, and keys need --frames" "$bin/dof-gather" plain.exr -o x.exr --focal-length 50 --sensor-width 36 --fstop 2 --focus-distance 1:3,5:6
fails_saying 2 '--focus-pixel: 500,500 lies outside of plain.exr, whose pixels go from 0,0 to 47,31' "$bin/dof-gather" plain.exr -o x.exr --focal-length 50 --sensor-width 36 --fstop 2 --focus-pixel 500,500
exits 0 "$bin/dof-gather" plain.exr -o x.exr --focal-length 50 --sensor-width 36 --lens-radius 0.1 --focus-pixel 20,16 --stats stats.json
grep -q '"focus_distance":2.0' stats.json || fail "--stats: $(cat stats.json)"

# For a view of the wrong size, only the size is reported.
picture make other.exr 40x30 R=0.1 G=0.1 B=0.1 A=1 Z=2 fill=1x1+5+5 Z=inf
fails_saying 1 'other.exr.*display window' "$bin/ldi-warp" plain.exr --view 0.1,0 other.exr -o x.exr "${lens[@]}"

# Every tool that reads pictures accepts unpremultiplied ones.
exits 0 "$bin/ldi-plan" straight.exr --unpremultiplied "${lens[@]}" --noise 0 -o plan.json
[ ! -s stderr ] || fail "ldi-plan --unpremultiplied: $(cat stderr)"
exits 0 "$bin/dof-compare" straight.exr straight.exr --unpremultiplied --json
if lab; then
    exits 0 "$bin/dof-accumulate" --view 0,0 soft.exr -o accumulated.soft.exr --lens-radius 0
    exits 0 "$bin/dof-accumulate" --view 0,0 straight.exr -o x.exr --lens-radius 0 --unpremultiplied
    same x.exr accumulated.soft.exr 1e-3
fi
