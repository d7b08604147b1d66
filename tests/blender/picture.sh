#!/bin/bash
# Blender to picture: renders a scene with Cycles, and with EEVEE, with share/blender/sparselens_views.py, makes depth
# of field from the views, and compares with the truth (Cycles' own depth of field; the average of many lens views of
# EEVEE) and with the best setting of Blender's own Defocus node.
#   bash picture.sh BIN_DIR [WIDTHxHEIGHT [TRUTH_SAMPLES [LENS_VIEWS [SAMPLES]]]]     480x270, 96, 24, 16 a view
. "$(dirname "$0")/common.sh"
size=${2:-480x270} truth_samples=${3:-96} lens_views=${4:-24} samples=${5:-16}

# The script of the Defocus node is for the compositor of Blender 3 and 4; for other versions there is the figure of
# lab/results/blender.md.
has_node() { blender -b --python-expr 'import bpy, sys; sys.exit(bpy.app.version >= (5, 0))' >/dev/null 2>&1; }
has_node || echo "skipped: the Defocus node, whose figure is that of Blender 3.4"

# best_node VIEWS TRUTH: the least error of the Defocus node over its f-stops, which are not the camera's.
best_node() {
    if ! has_node; then
        echo 27.2
        return
    fi
    local fstops=(1 2 4 5.6 8 11 16 22) fstop
    oiiotool "$1"/center.exr --ch Z,Z,Z --chnames R,G,B -d float -o depth.exr
    in_blender cycles.blend -P "$scene" -- CYCLES "$size" defocus "$PWD/$1/center.exr" "$PWD/depth.exr" "$PWD/node_" "${fstops[@]}"
    grep -oE 'DEFOCUS .*' said >&2
    for fstop in "${fstops[@]}"; do
        case $fstop in *.*) ;; *) fstop=$fstop.0 ;; esac
        decibels "node_$fstop.exr" "$2"
    done | sort -g | tail -n 1
}

in_blender -P "$scene" -- CYCLES "$size" save "$PWD/cycles.blend"
in_blender cycles.blend -P "$views" -- "${plain[@]}" -o cycles --views 4 --samples "$samples"
in_blender cycles.blend -P "$scene" -- CYCLES "$size" truth "$truth_samples" "$PWD/truth.exr"
started=$(date +%s.%N)
defocused picture.exr cycles/center.exr cycles/view_*.exr
echo "the shell recipe: $(awk -v a="$started" -v b="$(date +%s.%N)" 'BEGIN { printf "%.2f", b - a }') s"
ours=$(decibels picture.exr truth.exr) node=$(best_node cycles truth.exr)
echo "Cycles: $ours dB, Defocus node at best $node dB"
better "$ours" "$node" 12 Cycles

# A plan, rendered by its rectangles, with several files per view.
"$bin/ldi-plan" cycles/center.exr --noise 0 -o plan.json >/dev/null
in_blender cycles.blend -P "$views" -- "${plain[@]}" -o planned --plan plan.json --samples "$samples"
"$bin/ldi-warp" cycles/center.exr planned/view_*.exr -o planned.ldi.exr
"$bin/dof-gather" planned.ldi.exr -o planned.exr
echo "Cycles, as planned: $(decibels planned.exr truth.exr) dB"
better "$(decibels planned.exr truth.exr)" "$node" 9 "Cycles, as planned"

in_blender cycles.blend -P "$scene" -- BLENDER_EEVEE "$size" save "$PWD/eevee.blend"
eevee_runs eevee || exit 0
in_eevee eevee.blend -P "$views" -- "${plain[@]}" -o eevee --views 4
in_eevee eevee.blend -P "$views" -- "${plain[@]}" -o lens --views 0 --lens-views "$lens_views" --samples 4
"$bin/dof-accumulate" lens/lens_*.exr --center lens/center.exr -o eevee_truth.exr
defocused eevee.exr eevee/center.exr eevee/view_*.exr
ours=$(decibels eevee.exr eevee_truth.exr) node=$(best_node eevee eevee_truth.exr)
echo "EEVEE: $ours dB, Defocus node at best $node dB"
better "$ours" "$node" $((lens_views >= 256 ? 8 : 4)) EEVEE # a truth of fewer views is noisy itself
