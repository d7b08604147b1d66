#!/bin/bash
# contact-sheet.sh BIN_DIR OUT [SCENE [SIZE [RAYS [FOLDER]]]]: looks of the lens on a test scene, each gathered from
# five views (left) beside its ray-traced reference (right), and a row of four of them in OUT-row.png; prints the error
# of each gathered picture. FOLDER keeps the traced pictures, which are not traced again. Needs oiiotool, and the font
# DejaVu Sans ($FONT names another one).
set -euo pipefail
usage="usage: contact-sheet.sh BIN_DIR OUT [SCENE [SIZE [RAYS [FOLDER]]]]"
bin=$(cd "${1:?$usage}" && pwd)
out=$(realpath "${2:?$usage}")
scene=${3:-lamps} size=${4:-640x360} rays=${5:-4096}
lenses=$(cd "$(dirname "$0")" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
traced=$(realpath "${6:-$scratch}")
mkdir -p "$traced"
cd "$scratch"

font=/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf # OpenImageIO finds fonts by name up to 2.4 only
[ -e "$font" ] || font=DejaVuSans

# Half the size with its name on top. Lamps are a thousand times as bright as the white wall beside them: a power curve
# shows both.
shown() {
    oiiotool "$1" --ch R,G,B --resize:filter=box 320x0 --clamp:min=0 --powc 0.3 --mulc 0.4 --clamp:max=1 \
        --text:x=5:y=13:size=12:color=0.8,0.8,0.8:font="${FONT:-$font}" "$3" -d uint8 -o "$2"
}
tiles=()
look() {
    local name=$1 truth=$traced/$scene.$1 label=$2
    shift 2
    [ -f "$truth/reference.exr" ] || "$bin/dof-trace" "$scene" --size "$size" --views 1 --spp 1 --reference "$rays" "$@" -o "$truth"
    "$bin/dof-gather" ldi.exr --quality final "$@" -o "$name.exr"
    "$bin/dof-compare" "$name.exr" "$truth/reference.exr" >figures
    awk -v look="${*:-no look}" '$1 == "psnr_tonemapped" { printf "%s: %.1f dB\n", look, $2 }' figures
    shown "$name.exr" "$name.gathered.png" "$label"
    shown "$truth/reference.exr" "$name.traced.png" traced
    tiles+=("$name.gathered.png" "$name.traced.png")
}

[ -f "$traced/$scene/center.exr" ] || "$bin/dof-trace" "$scene" --size "$size" -o "$traced/$scene"
"$bin/ldi-warp" "$traced/$scene"/center.exr "$traced/$scene"/view_*.exr -o ldi.exr
look round round
look blades6 '6 blades' --blades 6 --blade-rotation 15
look squeeze2 'squeeze 2' --squeeze 2
look mirror 'picture of a mirror lens' --aperture "$lenses/mirror.exr"
look spherical 'spherical 0.7' --spherical 0.7
look cateye "cat's eye 1" --cat-eye 1
look catdark "cat's eye 1, darkening" --cat-eye 1 --cat-eye-darkening
look petzval 'petzval.json' --lens "$lenses/petzval.json"
look chroma 'axial chromatic 0.1' --axial-chromatic 0.1
look curve 'field curvature 0.3' --field-curvature 0.3
look tilt 'tilt 10,5' --tilt 10,5
look breath 'breathing 1' --breathing 1
oiiotool "${tiles[@]}" --mosaic:pad=2 "4x$((${#tiles[@]} / 4))" --nosoftwareattrib --eraseattrib '.*' -o "$out"
oiiotool {blades6,mirror,cateye,chroma}.gathered.png --mosaic:pad=2 4x1 --nosoftwareattrib --eraseattrib '.*' \
    -o "${out%.png}-row.png"
