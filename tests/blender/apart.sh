#!/bin/bash
# Volumes in slices (--slices) and see-through layers (--layers), on pictures of 96x54: closed forms, and Blender's own
# pinhole pictures. A few minutes.
#   bash apart.sh BIN_DIR
. "$(dirname "$0")/common.sh"
in_blender -P "$scene" -- CYCLES 96x54 save "$PWD/small.blend"
value() { picture pixel "$1" "$2" "$3"; }
near() { awk -v a="$1" -v b="$2" -v by="$3" 'BEGIN { exit !(a >= b - by && a <= b + by) }' || fail "$4: $1, not $2"; }

# Black volumes transmit exp(-density depth), here exp(-1) and exp(-0.6). Each has its own slices, which end where it
# ends, and the views show none of it.
variant small soot,pinhole
in_blender soot,pinhole.blend -P "$views" -- "${plain[@]}" -o soot --samples 64 --views 1 --slices 5
[ "$(cd soot && echo *)" = "center.exr view_0.exr volume.exr" ] || fail "--slices wrote $(ls soot)"
exrheader soot/volume.exr >header
slices=$(sed -n 's/^sparselens:sliceDepths .*"\(.*\)"/\1/p' header)
[ "$(wc -w <<<"$slices")" -eq 5 ] || fail "5 slices: $slices"
grep -q '^5,.*,7 10,.*,13$' <<<"$slices" || fail "the slices are not those of the volumes: $slices"
"$bin/dof-gather" soot/volume.exr --fstop inf -o soot.exr
near "$(value soot.exr 48,27 A)" "$(awk 'BEGIN { print 1 - exp(-1.6) }')" 0.004 "the coverage of soot"
in_blender soot,pinhole.blend -P "$variants" -- render 64 1 1 "$PWD/own.####.exr"
oiiotool soot/center.exr --ch R,G,B,A --mulc "$(awk 'BEGIN { t = exp(-1.6); print t "," t "," t ",1" }')" -o dimmed.exr
alike dimmed.exr own.0001.exr 50
echo "--slices: closed forms"

# Smoke with solids in it: views and slices flatten to Blender's own picture, light and shadow included; without the
# slices they do not. 512 samples differ by their noise.
variant small smoke,pinhole
in_blender smoke,pinhole.blend -P "$views" -- "${plain[@]}" -o smoke --samples 128 --views 2 --slices 6
in_blender smoke,pinhole.blend -P "$variants" -- render 512 1 1 "$PWD/own.####.exr"
"$bin/ldi-warp" smoke/center.exr smoke/view_?.exr -o solids.ldi.exr
"$bin/ldi-cluster" solids.ldi.exr smoke/volume.exr -o smoke.ldi.exr
for name in solids smoke; do "$bin/dof-gather" $name.ldi.exr --fstop inf --overscan crop -o $name.exr; done
echo "smoke: $(decibels smoke.exr own.0001.exr) dB, without the slices $(decibels solids.exr own.0001.exr)"
alike smoke.exr own.0001.exr 36
unlike solids.exr own.0001.exr 30

# The same by --picture, which keeps the files of an earlier run with the same slices.
in_blender smoke,pinhole.blend -P "$views" -- "${plain[@]}" --picture -o "$PWD/shot.exr" --views-folder smoke --samples 128 --views 2 --slices 6 --tools "$bin"
grep -q "of 0 views rendered and 4 kept" said || fail "--picture --slices: $(tail -n 3 said)"
"$bin/dof-gather" smoke.ldi.exr --overscan crop -o hand.exr
alike shot.exr hand.exr 70
in_blender smoke,pinhole.blend -P "$views" -- "${plain[@]}" --picture -o "$PWD/flat.exr" --views-folder smoke --samples 128 --views 2 --tools "$bin"
grep -q "of 3 views rendered and 0 kept" said || fail "without --slices: $(tail -n 3 said)"
unlike flat.exr shot.exr 70
echo "--picture --slices: the same picture"

# A sheet of coverage 0.5 in a layer of its own: its views show it alone, the others what is behind it. The sheet shines,
# so the noise of the others is not that of the scene without it.
variant small sheet,pinhole
in_blender sheet,pinhole.blend -P "$views" -- "${plain[@]}" -o sheet --samples 64 --views 2 --layers "Thin sheet"
[ "$(cd sheet && echo * Thin_sheet/*)" = "Thin_sheet center.exr view_0.exr view_1.exr $(echo Thin_sheet/{center,view_0,view_1}.exr)" ] || fail "--layers wrote $(ls sheet sheet/*)"
near "$(value sheet/Thin_sheet/center.exr 80,27 A)" 0.5 0.1 "the sheet's coverage"
near "$(value sheet/Thin_sheet/center.exr 80,27 Z)" 2 0.001 "the sheet's depth"
near "$(value sheet/Thin_sheet/center.exr 10,27 A)" 0 0 "beside the sheet"
in_blender small.blend -P "$views" -- "${plain[@]}" -o whole --samples 64 --views 0
alike sheet/center.exr whole/center.exr 36
in_blender sheet,pinhole.blend -P "$variants" -- render 256 1 1 "$PWD/own.####.exr"
in_blender sheet,pinhole.blend -P "$views" -- "${plain[@]}" --picture -o "$PWD/sheet.exr" --views-folder sheet --samples 64 --views 2 --layers "Thin sheet" --tools "$bin"
"$bin/dof-gather" sheet/ldi.exr --fstop inf --overscan crop -o sheet.exr
alike sheet.exr own.0001.exr 36
echo "--layers: the sheet and what is behind it"

says() { # PATTERN BLEND OPTION...
    exits 1 blender -b "$2.blend" -P "$views" -- -o none --samples 1 "${@:3}"
    grep -Eq "error: $1" stderr || fail "'$1' is not in: $(cat stderr)"
    [ ! -e none ] || fail "an error left files: $(ls none)"
}
says '--slices: no material of the scene has a volume' small --slices 4
says "--layers: the scene has no object and no collection 'veil'" small --layers veil
in_blender smoke,pinhole.blend -P "$variants" -- eevee "$PWD/eevee.blend"
says '--slices: only Cycles renders them' eevee --slices 4
echo "--slices and --layers: errors"
