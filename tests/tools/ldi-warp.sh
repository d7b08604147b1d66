#!/bin/bash
# ldi-warp from the shell: its output, the effect of each option, and its failures.
. "$(dirname "$0")/check.sh"
. "$source_dir/tests/tools/deep.sh"
warp=$bin/ldi-warp
center=views/center.exr

answers_help ldi-warp $center -o out.exr

# All tools can read its output.
exits 0 "$warp" $center "${rim[@]}" -o average.exr
[ ! -s stdout ] && [ ! -s stderr ] || fail "talks: $(cat stdout stderr)"
exits 0 oiiotool --info -v average.exr
grep -q 'deep' stdout || fail "oiiotool sees no deep picture: $(cat stdout)"
says average.exr '^type .*"deepscanline"'
says average.exr '^compression .*(zip, individual|zips: |zstd)'
says average.exr '^ +Z, 32-bit floating-point'
for channel in R G B A ldi.dx ldi.dy ldi.weight; do says average.exr "^ +$channel, 16-bit floating-point"; done
says average.exr '^focus .*: 5$'
says average.exr '^aperture .*: 0.3$'
says average.exr '^worldToCamera'
says average.exr '^sparselens:lensPoints .*"0,0 0\.0[56][0-9]*,0 [^ ]* -0\.0[56][^ ]* [^ ]*"$'
says average.exr '^displayWindow .*\(0 0\) - \(95 53\)'

# --merge keep: flattened by any tool it equals the centre view; --merge average gives another picture.
exits 0 "$warp" $center "${rim[@]}" -o keep.exr --merge keep
oiiotool keep.exr --flatten -o flat.exr
same_pixels flat.exr $center "a kept LDI flattens to the centre view"
says keep.exr '^dataWindow .*\(0 0\) - \(95 53\)'
exits 0 "$warp" $center "${rim[@]}" -o default.exr --merge average
same default.exr average.exr "average is the default"
differ keep.exr average.exr "--merge"
exits 0 "$warp" $center "${rim[@]}" -o whole.exr --silhouettes whole
differ_samples whole.exr average.exr "--silhouettes"
exits 0 "$bin/dof-trace" mirror -o mirror --size 160x90 --views 2 --spp 4 --focus-distance 12 --lens-radius 0.2
exits 0 "$warp" mirror/center.exr mirror/view_*.exr -o tested.exr
exits 0 "$warp" mirror/center.exr mirror/view_*.exr -o assumed.exr --agreement assume
differ_samples tested.exr assumed.exr "--agreement"
exits 0 "$warp" mirror/center.exr mirror/view_*.exr -o surfaces.exr --optical off
differ_samples tested.exr surfaces.exr "--optical"
says tested.exr '^ +ldi.optical, 32-bit floating-point'
for plain in surfaces.exr assumed.exr average.exr; do
    ! exrheader "$plain" | grep -q ldi.optical || fail "$plain has depths of images"
done
for value in both 1 ''; do
    fails_saying 2 '--agreement.*test|assume' "$warp" $center -o x.exr --agreement "$value"
    fails_saying 2 '--optical.*on|off' "$warp" $center -o x.exr --optical "$value"
    fails_saying 2 '--merge.*average|keep' "$warp" $center -o x.exr --merge "$value"
    fails_saying 2 '--silhouettes.*split|whole' "$warp" $center -o x.exr --silhouettes "$value"
done

# One view is an LDI too, and needs no lens.
picture edit $center bare.exr 'erase=.*'
exits 0 "$warp" bare.exr -o one.exr
oiiotool one.exr --flatten -o flat.exr
same_pixels flat.exr $center "the LDI of one view flattens to it"

# --view gives a camera's position, before or after the others; any number of views, in any order.
placed=(--view -0.06,0 views/view_2.exr)
exits 0 "$warp" $center views/view_0.exr -o by_metadata.exr
exits 0 "$warp" $center "${placed[@]}" -o after.exr
exits 0 "$warp" "${placed[@]}" $center -o before.exr
exits 0 "$warp" -o between.exr "${placed[@]}" -- $center
same after.exr before.exr "--view after and before the centre view"
same after.exr between.exr "--view before --"
exits 0 "$warp" $center --view 0.0599999987,0 views/view_0.exr -o exactly.exr # as stored in float
same_samples exactly.exr by_metadata.exr "a camera placed by hand and one by its metadata"
exits 0 "$warp" $center --view 0.06,0 views/view_2.exr -o elsewhere.exr
differ after.exr elsewhere.exr "--view X"
for text in abc 1 1, ,1 1,2,3 nan,0 0,inf; do fails_saying 2 "--view.*$text" "$warp" $center --view "$text" "${rim[0]}" -o x.exr; done
picture edit "${rim[0]}" lost.exr erase=worldToCamera
fails_saying 2 'lost.exr.*--view' "$warp" $center lost.exr -o x.exr

# A view whose frustum is shifted, here 6 pixels to the right and 3 down, so that it has the same rays, gives the same
# LDI, however its position is given.
exits 0 "$bin/dof-trace" fence --size 96x48 --overscan 8 --spp 1 --views 1 -o straight
oiiotool straight/view_0.exr --origin -2-5 --fullsize 96x48+0+0 --attrib:type=matrix worldToNDC \
    1,0,0,0,0,-2,0,0,0.5625,0.5625,1,1,-0.06,0,-1,0 -o off_axis.exr
picture edit off_axis.exr believed_straight.exr erase=worldToNDC
exits 0 "$warp" straight/center.exr straight/view_0.exr -o straight.exr
exits 0 "$warp" straight/center.exr off_axis.exr -o shifted.exr -v
same_samples shifted.exr straight.exr "an off-axis view of the same rays"
grep -q '^ldi-warp: off_axis.exr: optical axis 6,3 pixels from that of the centre view' stderr || fail "-v does not tell it: $(cat stderr)"
exits 0 "$warp" straight/center.exr --view 0.0599999987,0 off_axis.exr -o shifted.exr
same_samples shifted.exr straight.exr "an off-axis view placed by hand"
exits 0 "$warp" straight/center.exr believed_straight.exr -o shifted.exr
grep -q 'warning: believed_straight.exr: disagrees' stderr || fail "a frustum that is not known is not noticed: $(cat stderr)"

# The number of threads does not matter; messages go to stderr.
exits 0 "$warp" $center "${rim[@]}" -o one_thread.exr --threads 1
exits 0 "$warp" $center "${rim[@]}" -o two_threads.exr --threads 2
same one_thread.exr average.exr "1 thread"
same two_threads.exr average.exr "2 threads"
exits 0 "$warp" $center "${rim[@]}" -o verbose.exr -v
grep -Eq '^ldi-warp: 5 views, [0-9]+ samples' stderr || fail "-v says nothing: $(cat stderr)"
same verbose.exr average.exr "-v"

# Every lens option changes the LDI or the messages.
lens=(--focal-length 36 --sensor-width 36 --lens-radius 0.06 --focus-distance 5 --scene-unit 1)
picture edit $center nolens.exr 'erase=focus|FNumber|worldToNDC|pinhole.*|sparselens:.*'
exits 0 "$warp" nolens.exr "${placed[@]}" "${lens[@]}" -o lens.exr
changed() { # OPTION VALUE: instead of the one above
    local arguments=() i
    for ((i = 0; i < ${#lens[@]}; i += 2)); do
        if [ "${lens[i]}" = "$1" ]; then arguments+=("$1" "$2"); else arguments+=("${lens[i]}" "${lens[i + 1]}"); fi
    done
    exits 0 "$warp" nolens.exr "${placed[@]}" "${arguments[@]}" -o changed.exr
}
changed --focal-length 30
differ_samples lens.exr changed.exr --focal-length
says changed.exr '^pinholeFocalLength .*: 30$'
changed --sensor-width 30
differ_samples lens.exr changed.exr --sensor-width
changed --lens-radius 3
differ_samples lens.exr changed.exr --lens-radius
changed --focus-distance 7
says changed.exr '^focus .*: 7$'
changed --scene-unit 0.1
says changed.exr '^focus .*: 0.5$'
exits 0 "$warp" nolens.exr "${placed[@]}" --focal-length 36 --sensor-width 36 --fstop 0.3 --focus-distance 5 --scene-unit 1 -o fstop.exr
same lens.exr fstop.exr "f/0.3 of 36 mm is a radius of 0.06 m"
fails_saying 2 '--focal-length' "$warp" nolens.exr "${placed[@]}" --sensor-width 36 -o x.exr
fails_saying 2 '--sensor-width' "$warp" nolens.exr "${placed[@]}" --focal-length 36 -o x.exr
refuses_wrong_lenses "$warp" $center -o x.exr

# The meaning of depth channels, and their choice.
for z in 4 0.25; do
    picture make z$z.exr 3x3 R=0.5 G=0.5 B=0.5 A=1 Z=$z
done
exits 0 "$warp" z4.exr -o planar.exr
exits 0 "$warp" z0.25.exr -o inverse.exr --depth inverse
same_samples planar.exr inverse.exr "--depth inverse"
exits 0 "$warp" z4.exr -o distance.exr --depth distance --focal-length 36 --sensor-width 36
exits 0 "$warp" z4.exr -o lens_only.exr --focal-length 36 --sensor-width 36
differ_samples distance.exr lens_only.exr "--depth distance"
fails_saying 2 '--focal-length' "$warp" z4.exr -o x.exr --depth distance
picture edit z4.exr named.exr channels=R,G,B,A,far.away=Z
exits 0 "$warp" named.exr -o by_name.exr --depth-channel far.away
same_samples planar.exr by_name.exr "--depth-channel"
fails_saying 1 'named.exr.*--depth-channel' "$warp" named.exr -o x.exr
fails_saying 1 'z4.exr.*far.away' "$warp" z4.exr -o x.exr --depth-channel far.away

# Standard input and output.
"$warp" - "${rim[@]}" -o - <$center >piped.exr || fail "through a pipe"
same piped.exr average.exr "through a pipe"
"$warp" $center --view -0.06,0 - -o - <views/view_2.exr | cat >piped.exr
same_samples piped.exr after.exr "a rim view through a pipe"

# Any name works.
cp $center "it's a \"centre\" view.exr"
cp $center ./-dash.exr
exits 0 "$warp" "it's a \"centre\" view.exr" -o "out put.exr"
exits 0 "$warp" -o ./-out.exr -- -dash.exr
same "out put.exr" ./-out.exr "odd names"

# The output may not be an input.
cp $center same.exr
fails_saying 2 "would overwrite the input same.exr" "$warp" same.exr "${rim[@]}" -o same.exr
same same.exr $center "a refused output"

# Failures: one line, exit 1, the old output unchanged.
fails_saying 1 'missing.exr: cannot open: No such file' "$warp" missing.exr -o x.exr
fails_saying 1 'center.exr: cannot create the folder' "$warp" $center -o views/center.exr/x.exr
fails_saying 1 'views: is a folder' "$warp" views -o x.exr
head -c 3000 $center >cut.exr
fails_saying 1 'cut.exr' "$warp" cut.exr -o x.exr
# Views are read at the same time: if two fail, the first is named, even if the other fails sooner.
head -c -1000 "${rim[0]}" >late.exr
for threads in 1 2 4; do
    fails_saying 1 'late.exr' "$warp" $center --view 0.06,0 late.exr --view 0,0.06 missing.exr -o x.exr --threads $threads
    fails_saying 1 'missing.exr' "$warp" $center --view 0,0.06 missing.exr --view 0.06,0 late.exr -o x.exr --threads $threads
done
picture edit $center narrow.exr frame=90x54
fails_saying 1 'narrow.exr: its display window differs' "$warp" $center --view 0.06,0 narrow.exr -o x.exr
picture edit $center poor.exr channels=R,G,A,Z
fails_saying 1 'poor.exr: has no channel B' "$warp" $center --view 0.06,0 poor.exr -o x.exr
[ ! -e x.exr ] || fail "a failure wrote x.exr"
survives_failure "$warp" cut.exr
survives_failure "$warp" $center --view 0.06,0 narrow.exr
fails_saying 2 '--output' "$warp" $center
fails_saying 2 'views|CENTER' "$warp" -o x.exr

# A view from another position than stated is noticed, with the position that would agree: the other way, nearer,
# farther, at the centre, and not at the centre.
said() { # PATTERN: in one line
    [ "$(wc -l <stderr)" -eq 1 ] || fail "not one line: $(cat stderr)"
    grep -Eq "$1" stderr || fail "not said: $1 ($(cat stderr))"
}
for wrong in -0.06,0 0.024,0 0.12,0 0,0; do
    exits 0 "$warp" views/center.exr --view $wrong views/view_0.exr -o x.exr
    said "warning: views/view_0.exr: disagrees .* stated position $wrong; it would agree at 0\.0(4[5-9]|[56]|7)[0-9]*,-?0(\.0[01]?[0-9]*)? \(--view .* views/view_0.exr\)\$"
done
"$bin/dof-trace" fence --size 200x112 --spp 2 -o wide
exits 0 "$warp" --focal-length 50 wide/center.exr wide/view_?.exr -o x.exr # it is 36
[ "$(grep -c 'disagrees' stderr)" -ge 3 ] && tail -n 1 stderr | grep -Eq 'warning: [34] views would agree at about 0\.[67].* or the focal length is about 3[0-9], not 50 \(--focal-length 3[0-9]\)$' || fail "not said: the focal length ($(cat stderr))"
"$bin/dof-trace" fence --size 96x54 --spp 1 --views 0 -o again
exits 0 "$warp" views/center.exr --view 0.06,0 again/center.exr -o x.exr
said 'warning: again/center.exr: disagrees .* stated position 0.06,0; it would agree at 0,0 '
exits 0 "$warp" views/center.exr --view 0.06,0 views/center.exr -o x.exr
said 'warning: views/center.exr: is the same picture as views/center.exr, though it is said to stand at 0.06,0 and that at 0,0; '
exits 0 "$warp" views/center.exr "${rim[@]}" --view 0.04,0.04 views/view_0.exr -o x.exr
said 'warning: views/view_0.exr: is the same picture as views/view_0.exr, though .* at 0.04,0.04 and that at 0.06,0; '

# The first view is the centre.
exits 0 "$warp" "${rim[@]}" -o x.exr
said 'warning: views/view_0.exr: stands at the edge of the lens, with all other views to one side; give the view from the middle first$'
exits 0 "$warp" "${rim[@]}" views/center.exr -o x.exr
said 'warning: views/view_0.exr: stands at the edge .*; give the view from the middle first, views/center.exr$'

# Correct views give no warnings, in any scene, nor do partial views from a plan.
silent() { [ ! -s stderr ] || fail "views in their places are complained of: $* ($(cat stderr))"; }
exits 0 "$warp" views/center.exr "${rim[@]}" -o x.exr
silent fence
traced grass 160x90 grass
for scene in grass mist lamps mirror slant planes; do
    [ $scene = grass ] || "$bin/dof-trace" $scene --size 160x90 --spp 4 -o $scene
    exits 0 "$warp" $scene/center.exr $scene/view_?.exr -o x.exr
    silent $scene
done
for scene in fence grass mist mirror; do
    "$bin/dof-trace" $scene --size 320x180 --spp 4 --views 0 -o planned_$scene
    exits 0 "$bin/ldi-plan" planned_$scene/center.exr -o plan.json --margin 0
    exits 0 "$bin/dof-trace" $scene --size 320x180 --spp 4 --plan plan.json -o planned_$scene
    exits 0 "$warp" planned_$scene/center.exr planned_$scene/view_?.exr -o x.exr
    silent "planned $scene"
done
picture make grey.exr 96x54 R=0.5 G=0.5 B=0.5 A=1 Z=4
exits 0 "$warp" grey.exr --view 0.06,0 grey.exr --view -0.06,0 grey.exr --focal-length 36 --sensor-width 36 -o x.exr
silent "one colour at one depth"

# Pixels of a wall that have the depth of the sky, as in smoke: one warning for a range of frames and all its views, with
# what to do; the wall is whole.
words=(R=0.5 G=0.5 B=0.5 A=1 Z=4)
for x in {10..80..10}; do for y in 10 30 40; do words+=("fill=1x1+$x+$y" Z=1e10); done; done
for frame in 1 2; do for view in speckled beside; do picture make $view.000$frame.exr 96x54 "${words[@]}"; done; done
exits 0 "$warp" speckled.####.exr --view 0.06,0 beside.####.exr --focal-length 36 --sensor-width 36 -o wall.####.exr --frames 1-2
[ "$(wc -l <stderr)" -eq 1 ] || fail "speckles: $(cat stderr)"
said 'warning: speckled.0001.exr: 24 pixels have the depth of the sky .*; if it is smoke or fog, render it by itself \(docs/renderers.md'
"$bin/dof-gather" wall.0002.exr --focal-length 36 --sensor-width 36 --fstop inf --focus-distance 4 --depth-out wall_depth.exr -o x.exr
[ "$(picture pixel wall_depth.exr 10,10 Z)" = 4 ] || fail "a speckle keeps its depth: $(picture pixel wall_depth.exr 10,10 Z)"
