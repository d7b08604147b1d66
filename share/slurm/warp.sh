#!/bin/bash
#SBATCH --job-name=sparselens-warp
#SBATCH --cpus-per-task=2
#SBATCH --requeue
#SBATCH --open-mode=append
# One frame of a Slurm array: the views of the frame become one layered depth image.
#
#   sbatch --array=1-24 warp.sh VIEWS OUTPUT
#
# VIEWS is the folder of center.####.exr, view_0.####.exr, ...; OUTPUT the folder of ldi.####.exr. docs/farm.md
# says more.
set -euo pipefail
views=$1 output=$2 frame=$SLURM_ARRAY_TASK_ID
rim=("$views"/view_*."$(printf %04d "$frame")".exr)
exec ldi-warp "$views/center.####.exr" "${rim[@]/%.????.exr/.####.exr}" -o "$output/ldi.####.exr" --frames="$frame"
