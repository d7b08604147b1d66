#!/bin/bash
# Cryptomattes from the views to the picture: the same ids, their coverage through the lens, and the header's
# description of them.
. "$(dirname "$0")/check.sh"
command -v oiiotool >/dev/null || skip "needs oiiotool (openimageio-tools)"
lens=(--focal-length 50 --sensor-width 36 --lens-radius 0.2 --focus-distance 6)

# Object 2.5e+38 at depth 2 on the left, object 1.5 at depth 6 on the right; only the header names the matte.
names=R,G,B,A,Z,things00.R,things00.G,things00.B,things00.A
oiiotool --pattern constant:color=1,0,0,1,2,2.5e38,1,0,0 12x16 9 --chnames $names -d float -o left.exr
oiiotool left.exr --pattern constant:color=0,1,0,1,6,1.5,1,0,0 24x16 9 --chnames $names --paste +0+0 -d float -o plain.exr
oiiotool plain.exr --attrib cryptomatte/ab12cd3/name things --attrib cryptomatte/ab12cd3/hash MurmurHash3_32 \
    --attrib cryptomatte/ab12cd3/conversion uint32_to_float32 --attrib cryptomatte/ab12cd3/manifest '{"a":"7f000000"}' -o view.exr

# ids FILE: the different values of the id channels of a flat picture.
values() { oiiotool "$1" --ch "$2" -o values.exr && oiiotool --dumpdata values.exr; }
ids() { values "$1" things00.R,things00.B | sed -nE 's/^ *Pixel [^:]*: *//p' | tr -s ' ' '\n' | sed '/^$/d' | sort -u | xargs; }
expected=$(ids view.exr)
[ "$(wc -w <<<"$expected")" -eq 3 ] || fail "ids of the view: $expected" # two and none
keeps_mattes() { # FILE
    oiiotool --info -v "$1" >info.txt
    grep -q 'cryptomatte/ab12cd3/name: "things"' info.txt && grep -q 'cryptomatte/ab12cd3/manifest: ' info.txt &&
        grep -q 'cryptomatte/ab12cd3/conversion: "uint32_to_float32"' info.txt || fail "$1: $(cat info.txt)"
    grep -q 'things00.R (float), .*' info.txt || ! grep -q '(half)' info.txt || fail "$1 has no float ids: $(cat info.txt)"
}
same_ids() { # FILE: and the two at half coverage where the edge was
    keeps_mattes "$1"
    [ "$(ids "$1")" = "$expected" ] || fail "$1 has the ids $(ids "$1") in place of $expected"
}
exits 0 "$bin/ldi-warp" view.exr "${lens[@]}" -o warped.exr
[ ! -s stderr ] || fail "ldi-warp says $(cat stderr)"
keeps_mattes warped.exr
exits 0 "$bin/ldi-cluster" warped.exr --layers 1 -o clustered.exr
[ ! -s stderr ] || fail "ldi-cluster says $(cat stderr)"
keeps_mattes clustered.exr
for method in lens selective $(of_lab scatter); do
    exits 0 "$bin/dof-gather" clustered.exr -o $method.exr -d half --method $method
    [ ! -s stderr ] || fail "dof-gather says $(cat stderr)"
    same_ids $method.exr
    grep -q 'R (half).*things00.R (float)' info.txt || fail "-d half makes ids halves: $(grep channel info.txt)"
done
# Through the lens both ids share pixels near the edge; flattened, no pixel is shared.
mixed() { values "$1" things00.A | grep Pixel | grep -cvE ': *0(\.0*)?$' || true; }
exits 0 "$bin/dof-gather" clustered.exr -o sharp.exr --lens-radius 0
same_ids sharp.exr
[ "$(mixed lens.exr)" -ge 32 ] && [ "$(mixed sharp.exr)" -eq 0 ] ||
    fail "the matte is not seen through the lens: $(mixed lens.exr) and $(mixed sharp.exr)"
if lab; then
    exits 0 "$bin/dof-accumulate" --view 0,0 view.exr --view 0.1,0 view.exr "${lens[@]}" -o accumulated.exr
    same_ids accumulated.exr
fi

# --channels takes a whole matte by its name; requests that would destroy ids are refused.
exits 0 "$bin/dof-gather" clustered.exr -o one.exr --channels things
same_ids one.exr
[ "$(oiiotool --info one.exr | grep -c '4 channel')" -eq 1 ] || fail "--channels things: $(oiiotool --info one.exr)"

# In files of Blender, the name begins with that of the view layer; the last part suffices if only one has it.
for layer in ViewLayer Back; do
    exits 0 oiiotool plain.exr --chnames "R,G,B,A,Z,$layer.things00.R,$layer.things00.G,$layer.things00.B,$layer.things00.A" \
        --attrib cryptomatte/ab12cd3/name $layer.things --attrib cryptomatte/ab12cd3/hash MurmurHash3_32 \
        --attrib cryptomatte/ab12cd3/conversion uint32_to_float32 -o $layer.exr
done
exits 0 "$bin/dof-gather" ViewLayer.exr "${lens[@]}" -o full.exr --channels ViewLayer.things
exits 0 "$bin/dof-gather" ViewLayer.exr "${lens[@]}" -o last.exr --channels things
cmp -s full.exr last.exr || fail "the last part of a name is another matte"
oiiotool ViewLayer.exr Back.exr --ch Back.things00.R,Back.things00.G --chappend \
    --attrib cryptomatte/0123456/name Back.things --attrib cryptomatte/0123456/conversion uint32_to_float32 -o two.exr
fails_saying 2 "'things' is the last part of Back.things.* and ViewLayer.things.*: give one" "$bin/dof-gather" two.exr "${lens[@]}" -o x.exr --channels things

# Ranks for two objects do not suffice where the lens mixes six.
six=() at=0
for id in 1.5 2.5 3.5 4.5 5.5 6.5; do
    six+=("--fill:color=0,1,0,1,2,$id,1,0,0" 4x16+$at+0)
    at=$((at + 4))
done
oiiotool --create 24x16 9 --chnames $names "${six[@]}" -d float --attrib cryptomatte/ab12cd3/name things \
    --attrib cryptomatte/ab12cd3/hash MurmurHash3_32 --attrib cryptomatte/ab12cd3/conversion uint32_to_float32 -o six.exr
exits 0 "$bin/dof-gather" six.exr "${lens[@]/0.2/0.8}" -o sixth.exr --channels things
grep -Eq 'six.exr: Cryptomatte things lacks [0-9]+ % of the coverage, because it has room for 2 objects a pixel' stderr ||
    fail "says nothing of lost objects: $(cat stderr)"
fails_saying 2 '--compression: dwaa would destroy the ids in channel things00' "$bin/dof-gather" clustered.exr -o x.exr --compression dwaa
