#!/bin/bash
# Take Picture and Finish of views that are rendered in other manners: with sub-pixels, with volumes in slices, with
# see-through layers, and at moments of a shutter. The pictures equal those by hand to the bit, and the scene is unchanged,
# also after errors. Pictures of 96x54; two minutes.
#   bash manners.sh BIN_DIR
. "$(dirname "$0")/by_hand.sh"
PATH=$bin:$PATH
in_blender -P "$scene" -- CYCLES 96x54 save "$PWD/small.blend"
each_variant small smoke sheet pan
warp() { ldi-warp "$@" 2>log || fail "$(cat log)"; }

# Sub-pixels, which the files tell. A draft has none, and half the size.
press small.blend fine set supersample=2 render set supersample_auto=True follow 2 48 set finish=8 finish set supersample_auto=False set supersample=1 \
    refuse "or the picture's size" refuse-finish "or the picture's size"
finished_by_hand fine "" fine --focus-distance 2
same fine/picture.exr "Finish, views of twice the size"
press small.blend fine set supersample=2 fstop 0.8 take
by_hand fine "" --fstop "$(python3 -c 'import struct; print(struct.unpack("f", struct.pack("f", 0.8))[0])')"
same fine/picture.exr "views of twice the size"
exrheader fine/center.exr | grep -F 'ldi.supersample (type int): 2' >/dev/null || fail "the views have no sub-pixels"
echo "sub-pixels: dof-gather's and dof-finish's bits, the scene unchanged"

# Volumes in slices.
press small.blend smoke set slices=3 refuse-render '"Slices of Volumes": no material of the scene has a volume'
press smoke.blend smoke set slices=3 render focus 3 take set finish=8 finish set layers="'veil'" refuse-render "no collection 'veil'"
[ -s smoke/volume.exr ] || fail "no slices: $(ls smoke)"
warp smoke/center.exr smoke/view_?.exr -o solids.ldi.exr
ldi-cluster solids.ldi.exr smoke/volume.exr -o hand.ldi.exr 2>log || fail "$(cat log)"
gathered_by_hand hand.ldi.exr --focus-distance 3
same smoke/gathered.exr "slices"
finish_by_hand smoke ""
same smoke/picture.exr "Finish, slices"
echo "slices: dof-gather's and dof-finish's bits, the scene unchanged"

# A see-through layer.
press sheet.blend sheet set layers="'Thin sheet'" render focus 3 take
for part in . Thin_sheet; do warp sheet/$part/center.exr sheet/$part/view_?.exr -o sheet/$part/hand.ldi.exr; done
ldi-cluster sheet/hand.ldi.exr sheet/Thin_sheet/hand.ldi.exr -o hand.ldi.exr 2>log || fail "$(cat log)"
gathered_by_hand hand.ldi.exr --focus-distance 3
same sheet/picture.exr "a see-through layer"
echo "see-through layers: dof-gather's bits, the scene unchanged"

# Moments of a shutter, whose pictures cannot be finished.
press pan.blend pan frame 3 set shutter=2 render focus 3 take refuse-finish 'set the moments of the shutter to 1' set shutter=4 refuse 'center_2.*is not there'
for moment in 0 1; do warp pan/center_$moment.exr pan/view_?_$moment.exr -o hand_$moment.ldi.exr; done
gathered_by_hand hand_%s.ldi.exr --focus-distance 3
same pan/picture.exr "moments"
echo "moments: dof-gather's bits, the scene unchanged"
