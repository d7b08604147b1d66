#!/bin/bash
# ldi-cluster from the shell: its output, the effect of each option, and its failures.
. "$(dirname "$0")/check.sh"
. "$source_dir/tests/tools/deep.sh"
cluster=$bin/ldi-cluster
answers_help ldi-cluster in.exr -o out.exr

exits 0 "$bin/ldi-warp" views/center.exr "${rim[@]}" -o ldi.exr
exits 0 "$bin/ldi-warp" views/center.exr "${rim[@]}" --merge keep -o keep.exr
oiiotool ldi.exr --eraseattrib focus --eraseattrib FNumber --eraseattrib worldToNDC --eraseattrib 'pinhole.*' \
    --eraseattrib 'sparselens:.*' -o nolens.exr

fewer() { [ "$(total "$1")" -lt "$(total "$2")" ] || fail "$1 has $(total "$1") samples, $2 $(total "$2"): $3"; }

# All tools can read its output.
exits 0 "$cluster" ldi.exr -o out.exr
[ ! -s stdout ] && [ ! -s stderr ] || fail "talks: $(cat stdout stderr)"
exits 0 oiiotool --info -v out.exr
grep -q 'deep' stdout || fail "oiiotool sees no deep picture: $(cat stdout)"
says out.exr '^type .*"deepscanline"'
for attribute in 'focus .*: 5$' 'aperture .*: 0.3$' worldToCamera sparselens:lensPoints sparselens:dataWindow; do
    says out.exr "^$attribute"
done

# --tolerance: 0 merges nothing; larger values leave fewer samples; 0.25 is the default.
exits 0 "$cluster" ldi.exr -o t0.exr --tolerance 0
same_samples t0.exr ldi.exr "--tolerance 0"
exits 0 "$cluster" ldi.exr -o t.exr --tolerance 0.25
same t.exr out.exr "the default tolerance"
exits 0 "$cluster" ldi.exr -o t1.exr --tolerance 1
exits 0 "$cluster" ldi.exr -o t9.exr --tolerance 9
fewer t1.exr t0.exr "--tolerance 1"
fewer t9.exr t1.exr "--tolerance 9"
for value in abc nan -1 inf; do fails_saying 2 "--tolerance.*$value" "$cluster" ldi.exr -o x.exr --tolerance $value; done

# --layers: no pixel has more, and surfaces visible from the front stay visible.
[ "$(most ldi.exr)" -gt 2 ] || fail "the LDI has too few samples to test with: $(most ldi.exr)"
for layers in 1 2; do
    exits 0 "$cluster" keep.exr -o layers.exr --layers $layers
    [ "$(most layers.exr)" -eq $layers ] || fail "--layers $layers left $(most layers.exr)"
    oiiotool layers.exr --flatten -o flat.exr
    same_pixels flat.exr views/center.exr "--layers $layers keeps what is in front"
done
exits 0 "$cluster" ldi.exr -o layers.exr --layers 0
same layers.exr out.exr "--layers 0 is no limit"
for value in abc -1 1.5; do fails_saying 2 "--layers.*$value" "$cluster" ldi.exr -o x.exr --layers $value; done

# The tolerance needs the lens, and each lens value matters; the number of layers does not need it.
lens=(--focal-length 36 --sensor-width 36 --fstop 0.3 --focus-distance 5 --scene-unit 1)
exits 0 "$cluster" nolens.exr -o layers_only.exr --layers 2 -v
grep -q 'the lens is unknown' stderr || fail "-v says of pixels without a lens: $(cat stderr)"
exits 0 "$cluster" nolens.exr "${lens[@]}" -o lens.exr
same_samples lens.exr out.exr "lens by options and by metadata"
fails_saying 2 '--fstop or --lens-radius' "$cluster" nolens.exr -o x.exr
fails_saying 2 '--fstop or --lens-radius' "$cluster" nolens.exr -o x.exr --layers 2 --tolerance 1
fails_saying 2 '--focal-length' "$cluster" nolens.exr -o x.exr --lens-radius 0.06
fails_saying 2 '--sensor-width' "$cluster" nolens.exr -o x.exr --lens-radius 0.06 --focal-length 36
exits 0 "$cluster" ldi.exr -o base.exr --tolerance 1
for change in '--focal-length 5' '--sensor-width 300' '--fstop 3' '--lens-radius 0.006' '--scene-unit 10'; do
    # shellcheck disable=SC2086
    exits 0 "$cluster" ldi.exr -o changed.exr --tolerance 1 $change
    fewer changed.exr base.exr "$change makes less blur"
done
exits 0 "$cluster" ldi.exr -o changed.exr --focus-distance 7
says changed.exr '^focus .*: 7$'
same_samples changed.exr out.exr "an LDI stays refocusable"
exits 0 "$cluster" ldi.exr -o pinhole.exr --lens-radius 0
[ "$(most pinhole.exr)" -eq 1 ] || fail "a pinhole needs one layer, not $(most pinhole.exr)"
refuses_wrong_lenses "$cluster" ldi.exr -o x.exr

# Flat pictures with depth are LDIs of one layer; options give the meaning of the depth channel.
for z in 4 0.25; do
    picture make z$z.exr 3x3 R=0.5 G=0.5 B=0.5 A=1 Z=$z
done
exits 0 "$cluster" z4.exr -o planar.exr --layers 1
exits 0 "$cluster" z0.25.exr -o inverse.exr --layers 1 --depth inverse
same_samples planar.exr inverse.exr "--depth inverse"
exits 0 "$cluster" z4.exr -o distance.exr --layers 1 --depth distance --focal-length 36 --sensor-width 36
differ_samples distance.exr planar.exr "--depth distance"
picture edit z4.exr named.exr channels=R,G,B,A,far.away=Z
exits 0 "$cluster" named.exr -o by_name.exr --layers 1 --depth-channel far.away
same_samples planar.exr by_name.exr "--depth-channel"
fails_saying 1 'named.exr.*--depth-channel' "$cluster" named.exr -o x.exr --layers 1

# The number of threads does not matter; -v reports how far samples moved.
for threads in 1 2; do
    exits 0 "$cluster" ldi.exr -o threads.exr --threads $threads
    same threads.exr out.exr "$threads threads"
done
exits 0 "$cluster" ldi.exr -o verbose.exr -v
grep -Eq '^ldi-cluster: [0-9]+ samples to [0-9]+, CoC changed by at most 0\.[0-9]+ px$' stderr || fail "-v: $(cat stderr)"

# Standard input and output; odd names; output equal to input.
"$cluster" - -o - <ldi.exr | cat >piped.exr
same_samples piped.exr out.exr "through a pipe"
says piped.exr "^compression .*: none"
"$bin/ldi-warp" views/center.exr "${rim[@]}" -o - | "$cluster" - -o - >piped.exr
same piped.exr out.exr "after ldi-warp in a pipe"
cp ldi.exr ./"-it's \"odd\".exr"
exits 0 "$cluster" -o "out put.exr" -- "-it's \"odd\".exr"
same "out put.exr" out.exr "odd names"
cp ldi.exr same.exr
fails_saying 2 "would overwrite the input same.exr" "$cluster" same.exr -o same.exr
same same.exr ldi.exr "a refused output"

# Failures: one line, exit 1, the old output unchanged.
fails_saying 1 'missing.exr: cannot open: No such file' "$cluster" missing.exr -o x.exr
fails_saying 1 'ldi.exr: cannot create the folder' "$cluster" ldi.exr -o ldi.exr/x.exr
head -c 9000 ldi.exr >cut.exr
fails_saying 1 'cut.exr' "$cluster" cut.exr -o x.exr
fails_saying 1 'standard stream' "$cluster" - -o x.exr
[ ! -e x.exr ] || fail "a failure wrote x.exr"
survives_failure "$cluster" cut.exr
fails_saying 2 '--output' "$cluster" ldi.exr
fails_saying 2 'IN' "$cluster" -o x.exr
fails_saying 1 'other.exr: cannot open' "$cluster" ldi.exr other.exr -o x.exr

# Several deep files are merged by depth, with the same result as by oiiotool, in either order.
oiiotool --pattern constant:color=0.25,0.5,0.125,0.5,4 16x8 5 --chnames R,G,B,A,Z -d float --deepen -o near.exr
oiiotool --pattern constant:color=0.5,0.25,1,1,9 16x8 5 --chnames R,G,B,A,Z -d float --deepen -o far.exr
exits 0 "$cluster" near.exr far.exr -o merged.exr --layers 9
exits 0 "$cluster" far.exr near.exr -o swapped.exr --layers 9
oiiotool merged.exr --flatten --ch R,G,B,A -o merged-flat.exr
oiiotool far.exr near.exr --deepmerge --flatten --ch R,G,B,A -o expected-flat.exr
picture same merged-flat.exr expected-flat.exr 1e-3 >found || fail "merged: $(cat found)"
same_samples merged.exr swapped.exr "the order of the files matters"
[ "$(picture samples merged.exr)" = "256 2" ] || fail "not two samples a pixel: $(picture samples merged.exr)"
oiiotool --pattern constant:color=0.5,0.25,1,1,9 24x8 5 --chnames R,G,B,A,Z -d float --deepen -o wide.exr
fails_saying 1 'wide.exr: its display window differs from that of near.exr' "$cluster" near.exr wide.exr -o x.exr --layers 9
fails_saying 2 'merged.exr would overwrite the input merged.exr' "$cluster" near.exr merged.exr -o merged.exr --layers 9

# Elements that no lens tells apart become one sample: the nearer hides the farther, glass shows what is behind it.
element() { # NAME COLOUR COVERAGE DEPTH
    oiiotool --pattern "constant:color=$2,$2,$2,$3,$4" 16x8 5 --chnames R,G,B,A,Z -d float --deepen -o "$1".exr
}
element tree 0.75 1 936
element trunk 0.125 1 950
element glass 0.125 0.5 940
element hill 0.5 1 951
lens=(--focal-length 50 --sensor-width 36 --lens-radius 5 --focus-distance 300)
for elements in 'tree trunk' 'trunk glass' 'hill glass trunk' 'glass tree hill'; do
    read -ra files <<<"${elements// /.exr }.exr"
    exits 0 "$cluster" "${files[@]}" "${lens[@]}" -o merged.exr
    [ "$(most merged.exr)" -eq 1 ] || fail "the lens tells $elements apart"
    oiiotool merged.exr --flatten --ch R,G,B,A -o merged-flat.exr
    expected=("${files[0]}")
    for file in "${files[@]:1}"; do expected+=("$file" --deepmerge); done
    oiiotool "${expected[@]}" --flatten --ch R,G,B,A -o expected-flat.exr
    picture same merged-flat.exr expected-flat.exr 1e-3 >found || fail "$elements: $(cat found)"
done
