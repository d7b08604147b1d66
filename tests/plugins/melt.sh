#!/bin/bash
# The effect for OpenFX in `melt`, where MLT has a host of OpenFX (7.38 and later): ten frames with a keyed focus distance
# equal dof-gather's PNGs within the rounding of 8 bits, and an error is printed.
#   bash melt.sh BIN_DIR FILE.ofx [LDI]
. "$(dirname "$0")/../tools/check.sh"
effect=$(realpath "$2") ldi=${3:+$(realpath "$3")}
export OFX_PLUGIN_PATH=${effect%/*.ofx.bundle/*} PATH=$bin:$PATH
name=openfx.org.sparselens.DepthOfField
command -v melt >/dev/null || skip "melt is not installed"
command -v oiiotool >/dev/null || skip "needs oiiotool (openimageio-tools)"
melt -query filters >filters 2>/dev/null </dev/null || true
if ! grep -q openfx filters; then skip "this melt has no host of OpenFX"; fi
grep -q "$name" filters || fail "melt does not find the effect: $(grep openfx filters)"

if [ -z "$ldi" ]; then
    picture make flat.exr 128x72 R=noise:1 G=noise:2 B=noise:3 A=1 Z=3 fill=40x30+30+20 R*=0.5 Z=1.5 fill=20x20+90+10 R*=0.5 G*=0.5 B*=0.5 A=0.5
    exits 0 ldi-warp flat.exr --focal-length 50 --sensor-width 36 --lens-radius 0.05 --focus-distance 2 -o shot.ldi.exr
    ldi=$scratch/shot.ldi.exr keys=1:1.5,10:3
fi
keys=${keys-1:5.5,10:6.6}
exits 0 dof-gather "$ldi" -o expected.####.png --frames 1-10 --focus-distance "$keys" --overscan crop
read -r width height < <(oiiotool --info expected.0001.png | sed -nE 's/.* : +([0-9]+) x +([0-9]+).*/\1 \2/p')
cat >profile <<END
description=of the picture
frame_rate_num=24
frame_rate_den=1
width=$width
height=$height
progressive=1
sample_aspect_num=1
sample_aspect_den=1
display_aspect_num=$width
display_aspect_den=$height
colorspace=709
END
IFS=:, read -r _ first _ last <<<"$keys"
exits 0 timeout 300 melt -profile "$scratch/profile" color:gray out=9 -filter $name "ldi=$ldi" "focus_distance=0=$first;9=$last" overscan=3 \
    -consumer avformat:made.%04d.png vcodec=png pix_fmt=rgba mlt_image_format=rgba real_time=-1 an=1
choice=() # a PNG of opaque pixels has no alpha
if oiiotool --info expected.0001.png | grep -q '3 channel'; then choice=(--ch R,G,B); fi
for frame in {0001..0010}; do
    oiiotool made.$frame.png "${choice[@]}" expected.$frame.png --fail 0.0041 --failpercent 0 --hardfail 0.0041 --diff >log 2>&1 ||
        fail "frame $frame is another picture ($(cat log))"
done
exits 0 timeout 100 melt -profile "$scratch/profile" color:gray out=0 -filter $name ldi=none.exr -consumer avformat:none.png vcodec=png real_time=-1 an=1
grep -q 'sparselens: .*none.exr: cannot open' stderr || fail "no error is printed: $(tail -n 3 stderr)"
echo "melt: fine"
