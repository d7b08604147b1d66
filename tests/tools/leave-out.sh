#!/bin/bash
# Work that a stage leaves out because the scene does not need it is never visible: each switch on compared with off,
# over test scenes. The bounds are those of lab/results/techniques.md.
#   bash leave-out.sh BIN_DIR [--all]     without --all (tools.leave-out-all), three scenes
. "$(dirname "$0")/check.sh"

decibels() { "$bin/dof-compare" "$1" "$2" | awk '$1 == "psnr_tonemapped" { print $2 }'; }
# agree LEAST A B WHAT: in tone-mapped dB.
agree() {
    local figure
    figure=$(decibels "$2" "$3")
    printf '%-8s %-40s %s dB (at least %s)\n' "$scene" "$4" "$figure" "$1"
    awk -v a="$figure" -v b="$1" 'BEGIN { exit !(a == "inf" || a + 0 >= b) }' || fail "$scene: $4: $figure dB, less than $1"
}

scenes=(element fence mirror)
[ "${2:-}" != --all ] || scenes=(element fence grass lamps macro mirror mist planes slant)
for scene in "${scenes[@]}"; do
    size=256x144
    [ $scene != lamps ] || size=640x360 # its lamps are on whole pixels there
    exits 0 "$bin/dof-trace" $scene --size $size --spp 4 -o $scene
    cd $scene
    exits 0 "$bin/ldi-warp" center.exr view_*.exr -o ldi.exr
    exits 0 "$bin/dof-gather" ldi.exr -d float -o whole.exr
    # Layers: those within the tolerance are merged.
    exits 0 "$bin/ldi-cluster" ldi.exr -o clustered.exr
    exits 0 "$bin/dof-gather" clustered.exr -d float -o clustered_picture.exr
    agree 44 clustered_picture.exr whole.exr "layers within 0.25 px merged"
    # Lens points: as many as the blur of a tile needs.
    exits 0 "$bin/dof-gather" ldi.exr -d float --lens-samples 2048 -o many.exr
    agree 38 whole.exr many.exr "lens points by tile against 2048"
    # Views: only the plan's requests.
    exits 0 "$bin/ldi-plan" center.exr --noise 0 -o plan.json --masks masks
    exits 0 "$bin/dof-trace" $scene --size $size --spp 4 --plan plan.json -o planned
    planned=()
    for view in planned/view_*.exr; do [ ! -e "$view" ] || planned+=("$view"); done
    exits 0 "$bin/ldi-warp" center.exr "${planned[@]}" -o planned.ldi.exr
    exits 0 "$bin/dof-gather" planned.ldi.exr -d float -o planned.exr
    agree 38 planned.exr whole.exr "views as planned (${#planned[@]})"
    # Channels that are not requested are missing, and the others unchanged.
    exits 0 "$bin/dof-gather" ldi.exr -d float --channels R,G -o fewer.exr
    exits 0 picture edit whole.exr whole_fewer.exr channels=R,G
    exits 0 picture same fewer.exr whole_fewer.exr
    printf '%-8s %-40s same bits\n' "$scene" "channels not asked for"
    cd ..
done
