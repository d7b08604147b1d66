#!/bin/bash
# --compression, and the default of each kind of output.
. "$(dirname "$0")/check.sh"
for tool in oiiotool exrheader; do command -v $tool >/dev/null || skip "needs $tool (openimageio-tools, openexr)"; done
lens=(--focal-length 50 --sensor-width 36 --lens-radius 0.1 --focus-distance 2)
# The names in exrheader up to OpenEXR 3.3; later versions write the name first.
declare -A called=([none]=none [rle]='run-length encoding' [zips]='zip, individual scanlines' [zip]='zip, multi-scanline blocks'
    [piz]=piz [pxr24]=pxr24 [b44]=b44 [b44a]=b44a [dwaa]='dwa, small scanline blocks' [dwab]='dwa, medium scanline blocks')
# The methods that this OpenEXR has.
mapfile -t methods < <("$bin/dof-gather" --help | sed -nE 's/.*--compression ([a-z0-9|]+).*/\1/p' | tr '|' '\n')
[ ${#methods[@]} -ge 10 ] || fail "--help names the methods ${methods[*]}"
compression_is() { # FILE METHOD
    exrheader "$1" | grep -x "compression (type compression): \(${called[$2]-}\|$2: .*\)" >said || fail "$1 is not $2: $(exrheader "$1" | grep ^compression)"
}

# A pattern that halves and DCT coefficients cannot store exactly.
oiiotool --pattern fill:topleft=0.1,0.5,0.2,0.5,4:bottomright=0.9,0.2,0.1,1,4 24x16 5 --chnames R,G,B,A,Z -d float -o plain.exr
for method in "${methods[@]}"; do
    oiiotool plain.exr --compression $method -o in.$method.exr
    exits 0 "$bin/dof-gather" plain.exr -o out.exr "${lens[@]}" --compression $method
    compression_is out.exr $method
    # Flat pictures keep the compression of a flat input.
    exits 0 "$bin/dof-gather" in.$method.exr -o out.exr --depth-out depth.exr "${lens[@]}"
    compression_is out.exr $method
    compression_is depth.exr $method
    lab || continue
    exits 0 "$bin/dof-accumulate" --view 0,0 in.$method.exr -o out.exr "${lens[@]}"
    compression_is out.exr $method
done
if lab; then
    exits 0 "$bin/dof-accumulate" --view 0,0 plain.exr -o out.exr "${lens[@]}" --compression rle
    compression_is out.exr rle
    "$bin/dof-gather" plain.exr -o - "${lens[@]}" | "$bin/dof-accumulate" --view 0,0 - -o out.exr "${lens[@]}"
    compression_is out.exr zip
fi

# LDIs: zips, or zstd where OpenEXR has it, from flat views; a deep file keeps its own.
mapfile -t deep < <("$bin/ldi-warp" --help | sed -nE 's/.*--compression ([a-z0-9|]+).*/\1/p' | tr '|' '\n')
[ ${#deep[@]} -ge 3 ] || fail "--help of ldi-warp names the methods ${deep[*]}"
usual=$([[ " ${deep[*]} " == *' zstd '* ]] && echo zstd || echo zips)
exits 0 "$bin/ldi-warp" in.piz.exr -o usual.exr
compression_is usual.exr $usual
for method in "${deep[@]}"; do
    exits 0 "$bin/ldi-warp" plain.exr -o ldi.exr --compression $method
    compression_is ldi.exr $method
    exits 0 "$bin/ldi-cluster" ldi.exr -o out.exr --layers 1
    compression_is out.exr $method
    exits 0 "$bin/ldi-cluster" usual.exr -o out.exr --layers 1 --compression $method
    compression_is out.exr $method
done
# A flat picture from a deep file, and a picture through a pipe, have the default.
exits 0 "$bin/ldi-warp" plain.exr -o ldi.exr --compression none
exits 0 "$bin/dof-gather" ldi.exr -o out.exr "${lens[@]}"
compression_is out.exr zip
"$bin/ldi-warp" plain.exr -o - | "$bin/ldi-cluster" - -o out.exr --layers 1
compression_is out.exr $usual

# A compression that the kind of output cannot have is wrong usage.
for tool in ldi-warp ldi-cluster; do
    fails_saying 2 "--compression: deep files have one of none, rle, zips,( zstd,)? not 'piz'" "$bin/$tool" plain.exr -o x.exr --compression piz
done
fails_saying 2 "--compression: flat files have one of none, rle, .*, dwab, .*not 'lzw'" "$bin/dof-gather" plain.exr -o x.exr --compression lzw
fails_saying 2 "--compression applies to EXR, not to x.png" "$bin/dof-gather" plain.exr -o x.png "${lens[@]}" --compression zip

# DWA changes channels that are named like colours, such as P.Y of a position: a warning says so. A warning also names ids
# that an input has in such a compression, or in halves.
oiiotool --pattern noise:type=uniform:min=-9:max=9 24x16 3 --chnames P.X,P.Y,P.Z -d float -o positions.exr
oiiotool plain.exr positions.exr --chappend -d float -o data.exr
exits 0 "$bin/dof-gather" data.exr -o out.exr "${lens[@]}" --compression dwaa
grep -q 'warning: out.exr: its compression .*changes the data of channel P.Y: give --compression zip' stderr || fail "data by dwaa: $(cat stderr)"
oiiotool data.exr -d half -o halves.exr
exits 0 "$bin/dof-gather" halves.exr -o out.exr "${lens[@]}" --compression b44
grep -q 'changes the data of channel P.[XYZ]: give --compression zip' stderr || fail "data by b44: $(cat stderr)"
exits 0 "$bin/dof-gather" data.exr -o out.exr "${lens[@]}" --compression piz
[ ! -s stderr ] || fail "data by piz: $(cat stderr)"
oiiotool --pattern noise:type=uniform:min=-9:max=9 24x16 4 --chnames Crypto00.R,Crypto00.G,Crypto00.B,Crypto00.A -d float -o ids.exr
oiiotool plain.exr ids.exr --chappend -d float --compression dwaa -o lost.exr
exits 0 "$bin/dof-gather" lost.exr -o out.exr "${lens[@]}"
grep -q 'lost.exr: the ids in channel Crypto00.. were changed by the compression dwaa' stderr || fail "ids by dwaa: $(cat stderr)"
oiiotool plain.exr ids.exr --chappend -d half -o halves.exr
exits 0 "$bin/dof-gather" halves.exr -o out.exr "${lens[@]}"
grep -q 'halves.exr: the ids in channel Crypto00.. are halves' stderr || fail "ids in halves: $(cat stderr)"
