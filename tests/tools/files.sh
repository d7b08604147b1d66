# Files as others write them: several parts, one a layer or one a view, tiles, every compression; the sky as each
# renderer has it, and the cameras of renderers.
#   bash files.sh BIN_DIR
. "$(dirname "$0")/check.sh"
flat=(--lens-radius 0 -d float)
same() { idiff -q -fail 0 -warn 0 "$1" "$2" >idiff.txt 2>&1 || fail "$3 ($(cat idiff.txt))"; }
names() { exrheader "$1" | sed -nE 's/^ +([A-Za-z.]+), (16|32)-bit.*/\1/p' | tr '\n' ' '; }

oiiotool --pattern fill:topleft=0.1,0.5,0.9,1:topright=1,0,0,1:bottomleft=0,1,0,1:bottomright=1,0.25,0.5,1 24x16 4 --chnames R,G,B,A -d float -o rgba.exr
oiiotool --pattern fill:topleft=2:topright=3:bottomleft=5:bottomright=9 24x16 1 --chnames Z -d float -o depth.exr
oiiotool rgba.exr --ch R,G,B --mulc 0.5 -o diffuse.exr
oiiotool rgba.exr depth.exr --chappend -d float -o one.exr
exits 0 "$bin/dof-gather" one.exr -o expected.exr "${flat[@]}"

# One part a layer: their channels become layers; the beauty goes first wherever it stands.
part() { oiiotool "$1" --sattrib oiio:subimagename "$2" "${@:4}" -d float -o "$3"; } # FILE NAME OUT [oiiotool...]
part rgba.exr rgba p_rgba.exr
part depth.exr depth p_depth.exr
part diffuse.exr diffuse p_diffuse.exr
oiiotool p_diffuse.exr p_rgba.exr p_depth.exr --siappendall -o layers.exr
exits 0 "$bin/dof-gather" layers.exr -o out.exr "${flat[@]}" --depth-out z.exr
[ "$(names out.exr)" = "A B G R diffuse.B diffuse.G diffuse.R " ] || fail "layers by parts: $(names out.exr)"
oiiotool out.exr --ch R,G,B,A -o cut.exr
same cut.exr expected.exr "the beauty's part"
oiiotool out.exr --ch diffuse.R,diffuse.G,diffuse.B --chnames R,G,B -o cut.exr
same cut.exr diffuse.exr "a layer's part"
oiiotool depth.exr -o cut.exr
same z.exr cut.exr "depth in a part of its own"

# One part a view: the first view is the picture.
part rgba.exr rgba.left l_rgba.exr --sattrib view left
part depth.exr depth.left l_depth.exr --sattrib view left
part diffuse.exr rgba.right r_rgba.exr --sattrib view right
part depth.exr depth.right r_depth.exr --sattrib view right
oiiotool l_rgba.exr r_rgba.exr l_depth.exr r_depth.exr --siappendall -o stereo.exr
exits 0 "$bin/dof-gather" stereo.exr -o out.exr "${flat[@]}"
[ "$(names out.exr)" = "A B G R " ] || fail "two views: $(names out.exr)"
same out.exr expected.exr "the first view"
exits 0 "$bin/ldi-warp" stereo.exr -o ldi.exr --merge keep
exits 0 "$bin/dof-gather" ldi.exr -o out.exr "${flat[@]}"
idiff -q -fail 1e-3 -warn 1e-3 out.exr expected.exr >idiff.txt || fail "ldi-warp of two views"

# Tiles and compressions that lose nothing.
for how in '--tile 8 8' '--compression none' '--compression rle' '--compression zips' '--compression piz'; do
    # shellcheck disable=SC2086
    oiiotool one.exr $how -o how.exr
    exits 0 "$bin/dof-gather" how.exr -o out.exr "${flat[@]}"
    same out.exr expected.exr "$how"
done

# The sky: whatever is written for it gives the picture of infinity. --far: the far clip is sky too.
lens=(--focal-length 50 --sensor-width 36 --fstop 0.5 --focus-distance 4 -d float)
sky() { # DEPTH TYPE OUT: the left half at depth 4, the right half sky
    oiiotool --pattern constant:color=0.5,0.25,1,1 24x16 4 --chnames R,G,B,A \
        --pattern constant:color="$1" 24x16 1 --chnames Z --fill:color=4 12x16+0+0 --chappend -d float -d Z="$2" -o "$3"
}
hash() { oiiotool --hash "$1" | grep SHA-1; } # idiff finds infinity different from itself
sky inf float sky.exr
exits 0 "$bin/dof-gather" sky.exr -o infinity.exr "${lens[@]}" --depth-out infinity_z.exr
for way in '1e10 float' '1e30 float' '65504 half' '1e10 half'; do
    sky $way sky.exr
    exits 0 "$bin/dof-gather" sky.exr -o out.exr "${lens[@]}" --depth-out z.exr
    same out.exr infinity.exr "sky as $way"
    [ "$(hash z.exr)" = "$(hash infinity_z.exr)" ] || fail "the depth of sky as $way"
done
sky 100 float sky.exr
exits 0 "$bin/dof-gather" sky.exr -o out.exr "${lens[@]}" --far 100
same out.exr infinity.exr "--far"
exits 0 "$bin/dof-gather" sky.exr -o out.exr "${lens[@]}" --depth-out z.exr
[ "$(hash z.exr)" != "$(hash infinity_z.exr)" ] || fail "--far changes nothing"
fails_saying 2 '--far' "$bin/dof-gather" sky.exr -o x.exr --far 0
fails_saying 2 '--far' "$bin/ldi-warp" sky.exr -o x.exr --far 0
fails_saying 2 '--far' "$bin/ldi-cluster" sky.exr -o x.exr --layers 1 --far 0
fails_saying 2 '--far' "$bin/ldi-plan" sky.exr -o x.json --far 0
fails_saying 2 '--far' "$bin/dof-compare" sky.exr sky.exr --far 0

# A renderer's camera: found, said, and where it contradicts itself, an error that names the option.
oiiotool one.exr --attrib:type=float cameraFocalLength 50 --attrib:type=float cameraFov 39.6 --attrib:type=float cameraFNumber 0.5 \
    -o vray.exr
exits 0 "$bin/dof-gather" vray.exr -o out.exr -d float --focus-distance 4 -v
grep -q 'focal length 50 (cameraFocalLength)' stderr || fail "-v does not say what was found: $(cat stderr)"
exits 0 "$bin/dof-gather" one.exr -o options.exr -d float --focus-distance 4 --focal-length 50 --fstop 0.5 --sensor-width 36.0032
idiff -q -fail 1e-4 -warn 1e-4 out.exr options.exr >idiff.txt || fail "V-Ray's lens is not that of the options"
fails_saying 2 'give --focus-distance' "$bin/dof-gather" vray.exr -o x.exr
oiiotool vray.exr --attrib:type=float pinholeFocalLength 35 -o both.exr
fails_saying 2 'pinholeFocalLength says 35, cameraFocalLength says 50.*give --focal-length' \
    "$bin/dof-gather" both.exr -o x.exr --focus-distance 4
exits 0 "$bin/dof-gather" both.exr -o out.exr -d float --focus-distance 4 --focal-length 50
idiff -q -fail 1e-4 -warn 1e-4 out.exr options.exr >idiff.txt || fail "--focal-length settles it"
[ ! -e x.exr ] || fail "a failure wrote x.exr"
