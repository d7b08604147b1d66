#!/bin/bash
# The layer of USD that ldi-plan writes, imported by Blender: five views that it renders from the imported cameras make
# as good a picture as those of the script, to 0.1 dB, against Cycles' own lens. A minute.
#   bash usd.sh BIN_DIR [WIDTHxHEIGHT [TRUTH_SAMPLES [SAMPLES]]]      240x135, 256, 64 a view
. "$(dirname "$0")/common.sh"
size=${2:-240x135} truth_samples=${3:-256} samples=${4:-64}
blender -b --python-expr 'import bpy, sys; sys.exit(0 if hasattr(bpy.ops.wm, "usd_import") and bpy.app.build_options.usd else 1)' >said 2>&1 ||
    skip "needs a Blender with USD"
usd_python
in_blender -P "$scene" -- CYCLES "$size" save "$PWD/still.blend"
in_blender still.blend -P "$scene" -- CYCLES "$size" truth "$truth_samples" "$PWD/truth.exr"
in_blender still.blend -P "$views" -- "${plain[@]}" -o script --samples "$samples"
defocused script.exr script/center.exr script/view_{0..3}.exr

exits 0 "$bin/ldi-plan" script/center.exr -o plan.json --views 0 --cameras shot.usda --up-axis Z
exits 0 "$bin/ldi-plan" --camera shot.usda --cameras views.usda
mkdir usd
in_blender still.blend -P "$source_dir/tests/blender/usd_views.py" -- "$PWD/views.usda" "$PWD/usd" "$samples"
grep CAMERA said
"$bin/ldi-warp" --camera views.usda usd/center.exr usd/view_{0..3}.exr -o - | "$bin/ldi-cluster" - -o - | "$bin/dof-gather" - -o usd.exr
by_script=$(decibels script.exr truth.exr) by_usd=$(decibels usd.exr truth.exr)
echo "views of the script: $by_script dB, of the layer: $by_usd dB ($size, $samples samples a view, truth of $truth_samples)"
better "$by_usd" "$by_script" -0.1 "views of the layer"
better "$by_script" "$by_usd" -0.1 "views of the script"
