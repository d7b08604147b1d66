#!/bin/bash
# The tests of share/blender; run by hand, because they need Blender and time.
#   bash run.sh BIN_DIR [WIDTHxHEIGHT [TRUTH_SAMPLES [LENS_VIEWS [SAMPLES]]]]      480x270, 96, 24, 16
# script.sh: the renders of the script; apart.sh: smoke in slices and see-through layers; pictures.sh: its pictures, and
# the add-on's; manners.sh: those of views rendered in other manners; shots.sh: ../shared/shots; window.sh: the add-on in
# a window; extension.sh: the add-on, installed; border.sh: renders of a border for dof-finish; mistakes.sh: common
# mistakes; denoised.sh: denoised views;
# animation.sh: animated cameras compared with Cycles' own lens; picture.sh: compared with Blender's Defocus node;
# usd.sh: views of the cameras of a layer of USD. The figures of lab/results/blender.md: 480x270 512 256 64, which takes
# hours.
set -euo pipefail
here=$(dirname "${BASH_SOURCE[0]}")
bin=${1:?usage: bash run.sh BIN_DIR [WIDTHxHEIGHT [TRUTH_SAMPLES [LENS_VIEWS [SAMPLES]]]]}
size=${2:-480x270} truth_samples=${3:-96} lens_views=${4:-24} samples=${5:-16}
bash "$here/script.sh" "$bin"
bash "$here/pictures.sh" "$bin"
bash "$here/manners.sh" "$bin"
bash "$here/shots.sh" "$bin" || [ $? -eq 77 ]
bash "$here/apart.sh" "$bin"
bash "$here/shutter.sh" "$bin"
bash "$here/window.sh" "$bin" || [ $? -eq 77 ]
bash "$here/extension.sh" "$bin"
bash "$here/border.sh" "$bin"
bash "$here/mistakes.sh" "$bin"
bash "$here/denoised.sh" "$bin" || [ $? -eq 77 ]
bash "$here/usd.sh" "$bin" || [ $? -eq 77 ]
bash "$here/animation.sh" "$bin" "$size" "$truth_samples" "$samples"
bash "$here/picture.sh" "$bin" "$size" "$truth_samples" "$lens_views" "$samples"
