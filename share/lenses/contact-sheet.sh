#!/bin/bash
# contact-sheet.sh BIN_DIR OUT.png [SCENE [SIZE [RAYS]]]: each look of the lens on a test scene, gathered from five views
# (left) beside its truth by ray tracing (right). Needs dof-trace and oiiotool.
set -euo pipefail
bin=$(cd "${1:?usage: contact-sheet.sh BIN_DIR OUT.png [SCENE [SIZE [RAYS]]]}" && pwd)
out=$(realpath "${2:?usage: contact-sheet.sh BIN_DIR OUT.png}")
scene=${3:-fence} size=${4:-320x180} rays=${5:-256}
lenses=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

"$bin/dof-trace" "$scene" --size "$size" -o views
"$bin/ldi-warp" views/center.exr views/view_*.exr -o ldi.exr
shown() { oiiotool "$1" --ch R,G,B --clamp:min=0:max=1 --powc 0.4545 -d uint8 -o "$2"; }
tiles=() rows=0
look() {
    "$bin/dof-gather" ldi.exr --quality final "$@" -o gathered.exr
    "$bin/dof-trace" "$scene" --size "$size" --views 1 --spp 1 --reference "$rays" "$@" -o traced
    "$bin/dof-compare" gathered.exr traced/reference.exr | sed -n "s/psnr_tonemapped */$*: /p"
    rows=$((rows + 1))
    shown gathered.exr $rows.a.png
    shown traced/reference.exr $rows.b.png
    tiles+=($rows.a.png $rows.b.png)
}
look --blades 0
look --blades 6 --blade-rotation 15
look --squeeze 2
look --lens "$lenses/mirror.json"
look --spherical 0.9
look --spherical -0.9
look --cat-eye 1
look --axial-chromatic 0.1
look --field-curvature 0.5
look --tilt 20,0
look --breathing 1
oiiotool "${tiles[@]}" --mosaic:pad=2 2x$rows -o "$out"
