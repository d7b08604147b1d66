#!/bin/bash
# dof-gather from the shell: its output, the effect of each option, and its failures.
. "$(dirname "$0")/check.sh"
. "$source_dir/tests/tools/deep.sh"
gather=$bin/dof-gather
answers_help dof-gather in.exr -o out.exr

# The centre view with a further layer, so that layers can be distinguished.
layered() { picture edit "$1" "$2" channels=R,G,B,A,Z,copy.R=R,copy.G=G half= float=Z; }
layered views/center.exr center.exr
for i in 0 1 2 3; do layered views/view_$i.exr view_$i.exr; done
exits 0 "$bin/ldi-warp" center.exr view_?.exr -o ldi.exr
exits 0 "$bin/ldi-warp" center.exr view_?.exr --merge keep -o keep.exr
oiiotool keep.exr --eraseattrib focus --eraseattrib FNumber --eraseattrib worldToNDC --eraseattrib 'pinhole.*' \
    --eraseattrib 'sparselens:.*' -o nolens.exr

# Its output: the centre view's windows, its channels as half, the camera; no depth.
exits 0 "$gather" ldi.exr -o out.exr
[ ! -s stdout ] && [ ! -s stderr ] || fail "talks: $(cat stdout stderr)"
says out.exr '^type .*"scanlineimage"'
says out.exr '^dataWindow .*\(0 0\) - \(95 53\)'
says out.exr '^displayWindow .*\(0 0\) - \(95 53\)'
for channel in R G B A copy.R copy.G; do says out.exr "^ +$channel, 16-bit floating-point"; done
says out.exr '^focus .*: 5$'
if exrheader out.exr | grep -q '^ *Z,'; then fail "a gathered picture has a depth"; fi

# A lens of radius 0 gives the flattened LDI, bit for bit, and needs no other value.
exits 0 "$gather" keep.exr -o pinhole.exr --lens-radius 0
same_pixels pinhole.exr center.exr "--lens-radius 0"
exits 0 "$gather" keep.exr -o pinhole.exr --fstop inf
same_pixels pinhole.exr center.exr "--fstop inf"
exits 0 "$gather" nolens.exr -o pinhole.exr --lens-radius 0
same_pixels pinhole.exr center.exr "--lens-radius 0 needs no other value"
exits 0 "$bin/ldi-warp" center.exr view_?.exr --silhouettes whole -o opaque.exr
exits 0 "$gather" opaque.exr -o pinhole.exr --lens-radius 0
oiiotool opaque.exr --flatten --crop 96x54+0+0 -o flat.exr
same_pixels pinhole.exr flat.exr "averaged, --lens-radius 0"
exits 0 "$gather" center.exr -o pinhole.exr --lens-radius 0
same_pixels pinhole.exr center.exr "a flat picture"

# changes OPTIONS...: the picture differs from the one without them.
changes() {
    exits 0 "$gather" ldi.exr -o changed.exr "$@"
    differ changed.exr out.exr "$*"
}
changes --method selective
! lab || changes --method scatter
changes --focus-distance 3
changes --focus-distance inf
changes --fstop 1
changes --lens-radius 0.03
changes --focal-length 50
changes --sensor-width 24
changes --scene-unit 2
changes --lens-samples 7
changes --layer-tolerance 9
exits 0 "$gather" ldi.exr -o lens.exr --method lens --quality normal --lens-samples 0 --layer-tolerance 0.25
same lens.exr out.exr "the defaults"
exits 0 "$gather" ldi.exr -o k4.exr --method selective
exits 0 "$gather" ldi.exr -o k1.exr --method selective --layers 1
differ k1.exr k4.exr "--layers"
for text in '--method magic' '--quality best' '--layers 0' '--layers x' '--lens-samples -1' '-d double' \
    '--focus-pixel 1' '--focus-pixel 1.5,2' '--focus-pixel a,b' '--channels nothing'; do
    # shellcheck disable=SC2086
    fails_saying 2 "[-][-]?${text#--}|${text%% *}" "$gather" ldi.exr -o x.exr $text
done

# Looks of the lens: each changes the picture, and wrong values are named.
picture make aperture.exr 4x3 Y=0 fill=4x2 Y=1
picture make black.exr 4x3 Y=0
changes --blades 5
exits 0 "$gather" ldi.exr -o blades.exr --blades 5
changes_blades() {
    exits 0 "$gather" ldi.exr -o changed.exr --blades 5 "$@"
    differ changed.exr blades.exr "$*"
}
changes_blades --blade-curvature 0.5
changes_blades --blade-rotation 20
exits 0 "$gather" ldi.exr -o turned.exr --blades 5 --blade-rotation 72
same_pixels turned.exr blades.exr "--blade-rotation by a whole blade"
exits 0 "$gather" ldi.exr -o round.exr --blades 5 --blade-curvature 1
same_pixels round.exr out.exr "--blade-curvature 1"
changes --squeeze 2
changes --spherical 0.5
changes --aperture aperture.exr
changes --cat-eye 1
changes --axial-chromatic 0.1
changes --field-curvature 0.5
changes --astigmatism 0.5
changes --tilt 20,0
changes --tilt 0,20
changes --breathing 1
exits 0 "$gather" ldi.exr -o pinhole.exr --lens-radius 0
exits 0 "$gather" ldi.exr -o breathing.exr --lens-radius 0 --breathing 1
differ pinhole.exr breathing.exr "--breathing without an aperture"
exits 0 "$gather" ldi.exr -o eye.exr --cat-eye 1
exits 0 "$gather" ldi.exr -o darkened.exr --cat-eye 1 --cat-eye-darkening
differ eye.exr darkened.exr "--cat-eye-darkening"
exits 0 "$gather" ldi.exr -o red-blue.exr --axial-chromatic 0.1 --axial-chromatic-type red-blue
for type in blue-yellow green-magenta; do
    exits 0 "$gather" ldi.exr -o $type.exr --axial-chromatic 0.1 --axial-chromatic-type $type
    differ $type.exr red-blue.exr "--axial-chromatic-type $type"
done

# Looks by name: they depend on the f-number, and options override them.
echo '{"name": "Test lens", "blades": 5, "spherical": {"0.2": 0.5, "0.4": 0.1}, "aperture": "aperture.exr"}' >lens.json
fails_saying 1 'none.json' "$gather" ldi.exr -o x.exr --lens none.json
exits 0 "$gather" ldi.exr -o lens.exr --lens lens.json --squeeze 1
says lens.exr '^lensModel .*"Test lens"'
differ lens.exr out.exr "--lens"
exits 0 "$gather" ldi.exr -o beaten.exr --lens lens.json --blades 0 --spherical 0
same_pixels beaten.exr out.exr "options beat --lens"
exits 0 "$gather" ldi.exr -o by-name.exr --lens "$source_dir/share/lenses/hexagon.json" --fstop 2
exits 0 "$gather" ldi.exr -o installed.exr --lens hexagon --fstop 2
same_pixels installed.exr by-name.exr "--lens by the name of an installed lens"
exits 0 "$gather" ldi.exr -o by-pipe.exr --lens <(cat "$source_dir/share/lenses/hexagon.json") --fstop 2
same_pixels by-pipe.exr by-name.exr "--lens through a pipe"
for lens in "$source_dir"/share/lenses/*.json; do exits 0 "$gather" ldi.exr -o shared.exr --lens "$lens"; done
for text in '{"blades": 2}' '{"no-look": 1}' '[]' '{"tilt": 3}' '{"spherical": {"wide": 1}}' '{"cat-eye-darkening": 1}'; do
    echo "$text" >bad.json
    fails_saying 1 'bad.json' "$gather" ldi.exr -o x.exr --lens bad.json
done

# Looks may be keyed by frame.
exits 0 "$gather" ldi.exr -o key.####.exr --frames 1,3 --tilt '1:0,0;5:40,0' --blades 5 --blade-rotation 1:0,3:20
exits 0 "$gather" ldi.exr -o at-3.exr --tilt 20,0 --blades 5 --blade-rotation 20
same key.0003.exr at-3.exr "keyed looks"
for text in '--blades 2' '--blades 4.5' '--blade-curvature 1.5' '--blade-rotation x' '--squeeze 0' '--squeeze inf' \
    '--spherical 2' '--blades nan' '--cat-eye -1' '--axial-chromatic 6' '--field-curvature 1.1' '--astigmatism -2' '--tilt 3' '--tilt 90,0' \
    '--breathing -1' '--axial-chromatic-type pink'; do
    # shellcheck disable=SC2086
    fails_saying 2 "${text%% *}" "$gather" ldi.exr -o x.exr $text
done
fails_saying 1 'black.exr.* black' "$gather" ldi.exr -o x.exr --aperture black.exr
fails_saying 1 'none.exr' "$gather" ldi.exr -o x.exr --aperture none.exr
fails_saying 2 '--aperture.*--blades|--blades.*--aperture' "$gather" ldi.exr -o x.exr --aperture aperture.exr --blades 5
for method in selective $(of_lab scatter); do
    for look in '--blades 5' '--squeeze 2' '--spherical 0.5' '--cat-eye 1' '--axial-chromatic 0.1' '--field-curvature 0.5' \
        '--astigmatism 0.5' '--tilt 3,0' '--breathing 1' '--aperture aperture.exr' '--lens lens.json'; do
        # shellcheck disable=SC2086
        fails_saying 2 "${look%% *}: works with --method lens only" "$gather" ldi.exr -o x.exr --method $method $look
    done
done

# The blades, their rotation and the squeeze may be in the header, as the script for Blender writes them.
oiiotool ldi.exr --attrib:type=int aperture_blades 5 --attrib:type=float aperture_rotation 0.5 \
    --attrib:type=float aperture_ratio 1.5 -o said.exr
exits 0 "$gather" said.exr -o by-header.exr
exits 0 "$gather" ldi.exr -o by-option.exr --blades 5 --blade-rotation 28.64788975654116 --squeeze 1.5
picture same by-header.exr by-option.exr 0.01 >/dev/null || fail "aperture_blades, aperture_rotation, aperture_ratio do not do what the options do"
says by-option.exr '^aperture_blades .*: 5$'
exits 0 "$gather" said.exr -o overruled.exr --blades 0 --squeeze 1 -d half
picture same overruled.exr out.exr 0.01 >/dev/null || fail "options do not beat the header"
exits 0 "$gather" said.exr -o selective.exr --method selective
grep -q "warning: method selective ignores the aperture's shape" stderr || fail "no warning: $(cat stderr)"

# A wider lens than the views' gives a warning, in one line.
exits 0 "$gather" ldi.exr -o wide.exr --lens-radius 0.09
grep -q '^dof-gather: warning: the aperture is larger' stderr && [ "$(wc -l <stderr)" -eq 1 ] || fail "no warning: $(cat stderr)"

# --focus-pixel uses the depth of the front sample there.
exits 0 "$gather" ldi.exr -o pixel.exr --focus-pixel 5,0 --depth-out depth.exr
exits 0 "$gather" ldi.exr -o distance.exr --focus-distance 18
same pixel.exr distance.exr "--focus-pixel on the wall"
differ pixel.exr out.exr "--focus-pixel"
fails_saying 2 '--focus-pixel' "$gather" ldi.exr -o x.exr --focus-pixel 1000,1000
fails_saying 2 '--focus-pixel' "$gather" ldi.exr -o x.exr --focus-pixel -1000,-1
fails_saying 2 '--focus-distance' "$gather" ldi.exr -o x.exr --focus-pixel 5,0 --focus-distance 3

# -v prints that distance.
exits 0 "$gather" ldi.exr -o x.exr --focus-pixel 5,0 -v
grep -qx 'dof-gather: the focus distance is 18, the depth of pixel 5,0' stderr || fail "-v does not say the distance: $(cat stderr)"

# --depth-out: the depth of the front, as float.
exits 0 "$gather" keep.exr -o x.exr --depth-out depth.exr
says depth.exr '^ +Z, 32-bit floating-point'
picture same depth.exr views/center.exr Z || fail "--depth-out is not the centre view's depth"
fails_saying 2 '--depth-out' "$gather" keep.exr -o x.exr --depth-out x.exr
rm x.exr

# --channels: names, layers, rgba; the remaining channels are unchanged.
names() { exrheader "$1" | sed -nE 's/^ +([A-Za-z.]+), (16|32)-bit.*/\1/p' | tr '\n' ' '; }
chosen() { # LIST NAMES
    exits 0 "$gather" ldi.exr -o chosen.exr --channels "$1"
    [ "$(names chosen.exr)" = "$2 " ] || fail "--channels $1 gives $(names chosen.exr)"
}
chosen rgba "A B G R"
same_pixels chosen.exr out.exr "--channels rgba"
chosen copy "copy.G copy.R"
chosen R,copy.G "R copy.G"
picture same out.exr chosen.exr R,copy.G || fail "--channels changes what is left"
chosen A A
fails_saying 2 "'depth'" "$gather" ldi.exr -o x.exr --channels R,depth

# A layer is gathered like the colours.
picture edit out.exr a.exr channels=R=copy.R,G=copy.G
picture same a.exr out.exr R,G || fail "a copy of red is not gathered as red is"

# --lens-point: the view through one point of the lens. To the right of the middle, objects before focus move to the
# left.
exits 0 "$gather" ldi.exr -o right.exr --lens-point 1,0
exits 0 "$gather" ldi.exr -o left.exr --lens-point -1,0
differ right.exr left.exr "--lens-point"
exits 0 "$gather" ldi.exr -o rim.exr --lens-point 0.71,0.71 # a point of the rim, rounded
exits 0 "$gather" ldi.exr -o rounded.exr --lens-point 0.708,0.708
cmp rim.exr rounded.exr || fail "--lens-point goes beyond the rim"
exits 0 "$gather" ldi.exr -o rim.exr --lens-point 0.708,0.707
for point in 1,1 0.72,0.72 nan,0; do
    fails_saying 2 'lens-point.*at most 1' "$gather" ldi.exr -o y.exr --lens-point $point
done
fails_saying 2 'lens-point.*method lens' "$gather" ldi.exr -o y.exr --lens-point 0,1 --method selective

# --show: information in false colours; the picture is not gathered.
pixel() { picture pixel "$1" "$2,$3" R,G,B,A; }
for what in coc focus layers tiles; do
    exits 0 "$gather" ldi.exr -o show.$what.exr --show $what -d float
    [ "$(names show.$what.exr)" = "A B G R " ] || fail "--show $what has $(names show.$what.exr)"
    says show.$what.exr '^dataWindow .*\(0 0\) - \(95 53\)'
    differ show.$what.exr out.exr "--show $what"
done
exits 0 "$gather" keep.exr -o x.exr --lens-radius 0 --show coc
pixel x.exr 40 30 | grep -qE '^1(\.0+)? 1(\.0+)? 1(\.0+)? 1' || fail "a pinhole has no blur: $(pixel x.exr 40 30)"
exits 0 "$gather" ldi.exr -o x.exr --show coc --focus-distance 1
pixel x.exr 5 0 | awk '{ exit !($1 == 1 && $3 < 1) }' || fail "the wall is behind focus: $(pixel x.exr 5 0)"
exits 0 "$gather" ldi.exr -o x.exr --show coc --focus-distance 1000
pixel x.exr 5 0 | awk '{ exit !($3 == 1 && $1 < 1) }' || fail "the wall is in front of focus: $(pixel x.exr 5 0)"
exits 0 "$gather" ldi.exr -o x.exr --show focus --focus-distance 18
pixel x.exr 5 0 | awk '{ exit !($2 > 0.49) }' || fail "the wall is in focus: $(pixel x.exr 5 0)"
exits 0 "$gather" center.exr -o x.exr --show layers
pixel x.exr 1 0 | grep -qE '^0\.50*[ ]' || fail "a flat picture has one layer: $(pixel x.exr 1 0)"
exits 0 "$gather" ldi.exr -o x.exr --show tiles --lens-samples 256
pixel x.exr 1 0 | grep -qE '^0(\.0+)? 1(\.0+)? 0' || fail "256 lens points are green: $(pixel x.exr 1 0)"
fails_saying 2 '--show tiles' "$gather" ldi.exr -o y.exr --show tiles --method selective
fails_saying 2 '--show.*coc' "$gather" ldi.exr -o y.exr --show me
rm x.exr

# -d half is the rounded result of -d float.
exits 0 "$gather" ldi.exr -o float.exr -d float
says float.exr '^ +R, 32-bit floating-point'
picture edit float.exr rounded.exr half=
same_pixels rounded.exr out.exr "-d float, rounded"
picture differ float.exr out.exr || fail "-d float changes nothing"
exits 0 "$gather" ldi.exr -o half.exr -d half
same half.exr out.exr "-d half of half"
oiiotool ldi.exr -d float -o float.ldi.exr
exits 0 "$gather" float.ldi.exr -o half.exr
says half.exr '^ +R, 32-bit floating-point'
exits 0 "$gather" float.ldi.exr -o half.exr -d half
says half.exr '^ +R, 16-bit floating-point'
same_pixels half.exr out.exr "-d half of float"

# Options that the chosen method would ignore are refused.
for text in '--quality final --method selective' '--layer-tolerance 1 --method selective' '--lens-samples 9 --method selective' '--holdout ldi.exr --method selective'; do
    # shellcheck disable=SC2086
    fails_saying 2 "^dof-gather: ${text%% *}: works with --method lens only" "$gather" ldi.exr -o y.exr $text
done
for method in lens $(of_lab scatter); do
    fails_saying 2 '^dof-gather: --layers: works with --method selective only' "$gather" ldi.exr -o y.exr --layers 2 --method $method
done
fails_saying 2 '^dof-gather: --layers: works with --method selective only' "$gather" ldi.exr -o y.exr --layers 2

# An option given twice is named with its values; -- ends options.
fails_saying 2 '^dof-gather: --fstop is given 2 times, with the values 2, 4: give it once' "$gather" -v ldi.exr -o y.exr --fstop 2 --fstop 4
fails_saying 2 '^dof-gather: --output is given 2 times, with the values y.exr, z.exr' "$gather" ldi.exr -o y.exr -o z.exr
fails_saying 2 '^dof-gather: --output is required' "$gather" -- ldi.exr
fails_saying 2 '^dof-gather: unknown argument: --f-stop; did you mean --fstop\? ' "$gather" ldi.exr -o y.exr --f-stop 2
fails_saying 2 '^dof-gather: unknown argument: --focus-distanse=3; did you mean --focus-distance\? ' "$gather" ldi.exr -o y.exr --focus-distanse=3
fails_saying 2 '^dof-gather: unknown argument: --nonsense \(see --help\)$' "$gather" ldi.exr -o y.exr --nonsense
fails_saying 2 '^dof-gather: unknown argument: -d' "$gather" -o y.exr -- ldi.exr -d
cp ldi.exr ./-v
cp ldi.exr ./--quality=final
for name in -v --quality=final; do
    exits 0 "$gather" -o dash.exr -- $name
    same dash.exr out.exr "-- $name"
    [ ! -s stderr ] || fail "-- $name is not a name: $(cat stderr)"
done

# The number of threads does not matter, for any method; -v changes no picture.
for method in lens selective $(of_lab scatter); do
    exits 0 "$gather" ldi.exr -o one.exr --threads 1 --method $method
    exits 0 "$gather" ldi.exr -o two.exr --threads 2 --method $method -v
    same one.exr two.exr "$method with 1 thread and with 2"
done

# Each lens value: the option, else the metadata, else an error that names the option.
lens=(--focal-length 36 --sensor-width 36 --fstop 0.30000001192092896 --focus-distance 5 --scene-unit 1)
exits 0 "$gather" nolens.exr -o options.exr "${lens[@]}"
picture edit options.exr options.exr half= # oiiotool converted all channels of nolens.exr to float
exits 0 "$gather" keep.exr -o metadata.exr
same_pixels options.exr metadata.exr "lens by options and by metadata"
without() {
    local left=() i
    for ((i = 0; i < ${#lens[@]}; i += 2)); do
        [ "${lens[i]}" = "$1" ] || left+=("${lens[i]}" "${lens[i + 1]}")
    done
    fails_saying 2 "give $1" "$gather" nolens.exr -o x.exr "${left[@]}"
}
for option in --focal-length --sensor-width --fstop --focus-distance; do without $option; done
refuses_wrong_lenses "$gather" ldi.exr -o x.exr

# The meaning of the depth channel, and its choice.
for z in 4 0.25; do
    picture make z$z.exr 5x5 R=0.5 G=0.5 B=0.5 A=1 Z=$z
done
exits 0 "$gather" z4.exr -o x.exr --lens-radius 0 --depth-out planar.exr
exits 0 "$gather" z0.25.exr -o x.exr --lens-radius 0 --depth-out inverse.exr --depth inverse
picture same planar.exr inverse.exr || fail "--depth inverse"
exits 0 "$gather" z4.exr -o x.exr --lens-radius 0 --depth-out distance.exr --depth distance \
    --focal-length 36 --sensor-width 36
picture differ planar.exr distance.exr || fail "--depth distance changes nothing"
picture edit z4.exr named.exr channels=R,G,B,A,far.away=Z
exits 0 "$gather" named.exr -o x.exr --lens-radius 0 --depth-out by_name.exr --depth-channel far.away
picture same planar.exr by_name.exr || fail "--depth-channel"
fails_saying 1 'named.exr.*--depth-channel' "$gather" named.exr -o x.exr --lens-radius 0
picture edit z4.exr behind.exr 'Z*=-1'
fails_saying 1 'behind.exr: depth -4.* in pixel 0,0' "$gather" behind.exr -o x.exr --lens-radius 0
fails_saying 2 'aperture.*--fstop.*focal length.*--focal-length.*sensor.*--sensor-width.*--focus-distance' "$gather" z4.exr -o x.exr
rm x.exr

# Standard input and output, all three tools; odd names.
"$gather" - -o - <ldi.exr | cat >piped.exr
same_pixels piped.exr out.exr "through a pipe"
exits 0 "$bin/ldi-cluster" ldi.exr -o clustered.exr
exits 0 "$gather" clustered.exr -o chain.exr
"$bin/ldi-warp" center.exr view_?.exr -o - | "$bin/ldi-cluster" - -o - | "$gather" - -o piped.exr
same piped.exr chain.exr "the chain in a pipe"
cp ldi.exr ./"-it's \"odd\".exr"
exits 0 "$gather" -o "out put.exr" -- "-it's \"odd\".exr"
same "out put.exr" out.exr "odd names"

# An output that is an input, under any name, is refused before anything is read or written.
cp ldi.exr input.exr
cp ldi.exr input.copy.exr
ln -s input.exr soft.exr
ln input.exr hard.exr
for output in input.exr ./input.exr "$PWD/input.exr" soft.exr hard.exr; do
    fails_saying 2 "--output $output would overwrite the input input.exr: name another output" "$gather" input.exr -o "$output"
    fails_saying 2 "--depth-out $output would overwrite the input input.exr" "$gather" input.exr -o x.exr --depth-out "$output"
    fails_saying 2 "--output $output would overwrite the input input.exr" "$gather" ldi.exr -o "$output" --holdout input.exr
done
fails_saying 2 '--output input.exr would overwrite the input soft.exr' "$gather" soft.exr -o input.exr
fails_saying 2 '--stats input.exr would overwrite' "$gather" input.exr -o x.exr --stats input.exr
fails_saying 2 '--output and --depth-out name the same file: -' "$gather" ldi.exr -o - --depth-out -
ln -s x.exr x.link.exr
fails_saying 2 '--output and --depth-out name the same file: x.link.exr' "$gather" ldi.exr -o x.exr --depth-out x.link.exr
same input.exr input.copy.exr "refused outputs"
[ ! -e x.exr ] || fail "a refused command wrote x.exr"
exits 0 "$gather" ldi.exr -o /dev/null --depth-out /dev/null

# Failures: one line, exit 1, the old output unchanged.
fails_saying 1 'missing.exr: cannot open: No such file' "$gather" missing.exr -o x.exr
exits 0 "$gather" ldi.exr -o new/folder/x.exr --depth-out other/folder/z.exr
same new/folder/x.exr out.exr "folders are made"
[ -s other/folder/z.exr ] || fail "no folder for --depth-out"
fails_saying 1 'ldi.exr/x.exr|ldi.exr: cannot create the folder' "$gather" ldi.exr -o ldi.exr/x.exr
head -c 9000 ldi.exr >cut.exr
fails_saying 1 'cut.exr' "$gather" cut.exr -o x.exr
[ ! -e x.exr ] || fail "a failure wrote x.exr"
survives_failure "$gather" cut.exr
fails_saying 2 '--output' "$gather" ldi.exr
fails_saying 2 'IN' "$gather" -o x.exr

# Highlight gain: light above the threshold is multiplied by the gain, with a transition over the knee.
picture make lights.exr 32x16 R=0.5 G=0.5 B=0.5 A=1 Z=5 fill=8x8+4+4 R=4 G=4 B=4
level() { picture pixel "$1" 7,7 R; }
exits 0 "$gather" lights.exr -o grown.exr --lens-radius 0 --highlight-gain 3
[ "$(level grown.exr)" = 12 ] || fail "--highlight-gain: $(level grown.exr) is not 12"
[ "$(picture pixel grown.exr 20,7 R)" = 0.5 ] || fail "--highlight-gain changes what is not bright"
exits 0 "$gather" lights.exr -o grown.exr --lens-radius 0 --highlight-gain 3 --highlight-threshold 5
[ "$(level grown.exr)" = 4 ] || fail "--highlight-threshold: $(level grown.exr) is not 4"
exits 0 "$gather" lights.exr -o grown.exr --lens-radius 0 --highlight-gain 3 --highlight-threshold 3 --highlight-knee 2
[ "$(level grown.exr)" = 8 ] || fail "--highlight-knee: $(level grown.exr) is not 8"
echo '{"highlight-gain": 3, "highlight-threshold": 3, "highlight-knee": 2}' >bright.json
exits 0 "$gather" lights.exr -o grown.exr --lens-radius 0 --lens bright.json
[ "$(level grown.exr)" = 8 ] || fail "highlight-gain in a lens file: $(level grown.exr) is not 8"
fails_saying 2 'highlight-gain' "$gather" lights.exr -o x.exr --lens-radius 0 --highlight-gain 0.5
fails_saying 2 'highlight-threshold' "$gather" lights.exr -o x.exr --lens-radius 0 --highlight-gain 2 --highlight-threshold -1
fails_saying 2 'highlight-knee' "$gather" lights.exr -o x.exr --lens-radius 0 --highlight-gain 2 --highlight-knee 0
fails_saying 2 'highlight-gain' "$gather" lights.exr -o x.exr --lens-radius 0 --highlight-knee 2
