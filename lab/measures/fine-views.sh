# The same rays in views of once, twice and four times the size: dB at final quality, and the cost. 15 minutes.
. "$(dirname "$0")/common.inc" "$1"

# row NAME REFERENCE PICTURE_SIZE ...: views of 1, 2 and 4 times the size, in folders NAME.N.
row() {
    local name=$1 reference=$2 n cells=() times=()
    for n in 1 2 4; do
        if [ -e "$name.$n/center.exr" ]; then
            # shellcheck disable=SC2046
            ldi-warp $(five_views "$name.$n") -o "$name.$n.ldi.exr" 2>/dev/null
            dof-gather "$name.$n.ldi.exr" --quality final ${fine[$n]-} -o "$name.$n.exr" 2>/dev/null
            cells+=("$(db "$name.$n.exr" "$reference")")
            times+=("$(cost dof-gather "$name.$n.ldi.exr" --quality final ${fine[$n]-} -o "$name.$n.exr" | cut -d ' ' -f 1)")
        else
            cells+=("") times+=("")
        fi
    done
    echo "| $name | ${cells[0]} | ${cells[1]} | ${cells[2]} | ${times[0]} | ${times[1]} | ${times[2]} |"
}

fine=([2]="--supersample 2" [4]="--supersample 4")
echo "| | 1x, dB | 2x | 4x | \`dof-gather\`, CPU seconds at 1x | 2x | 4x |"
echo "|---|---|---|---|---|---|---|"
for scene in fence grass; do
    trace "$scene.truth" $scene --size 640x360 --views 0 --reference 2048
    for n in 1 2 4; do trace "$scene.$n" $scene --size 640x360 --spp 16 --supersample $n; done
    row $scene "$scene.truth/reference.exr"
done
for scene in yard pelt; do # path-traced at once and twice the size
    [ -e "$shared/views/${scene}_2x" ] || { echo "skipped: $scene, as there is no ../shared" >&2; continue; }
    ln -sfn "$shared/views/$scene" "$scene.1"
    ln -sfn "$shared/views/${scene}_2x" "$scene.2"
    row $scene "$shared/views/$scene/reference.exr"
done
