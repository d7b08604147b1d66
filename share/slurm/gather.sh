#!/bin/bash
#SBATCH --job-name=sparselens-gather
#SBATCH --cpus-per-task=2
#SBATCH --requeue
#SBATCH --open-mode=append
# One frame of a Slurm array: the layered depth image of the frame becomes a picture.
#
#   sbatch --array=1-24 --dependency=aftercorr:WARP_JOB gather.sh OUTPUT [OPTIONS OF DOF-GATHER]
#
# OUTPUT is the folder of ldi.####.exr and picture.####.exr. With aftercorr, each frame waits only for its own layered
# depth image. docs/farm.md says more.
set -euo pipefail
output=$1 frame=$SLURM_ARRAY_TASK_ID
exec dof-gather "$output/ldi.####.exr" -o "$output/picture.####.exr" --frames="$frame" "${@:2}"
