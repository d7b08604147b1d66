#!/bin/bash
#SBATCH --job-name=sparselens-blender
#SBATCH --cpus-per-task=2
#SBATCH --requeue
#SBATCH --open-mode=append
# One frame of a Slurm array: Blender renders the views of the frame, and the tools make its picture.
#
#   sbatch --array=1-24 blender.sh SHOT.blend '//out/####' [OPTIONS]
#
# Options are those of the command, e.g. --samples 64 --finish 80 (share/blender/README.md). Blender 4.2 and later needs
# the add-on; if $SPARSELENS_VIEWS is the path of sparselens_views.py, any Blender serves. A task that Slurm restarts
# keeps finished views. docs/farm.md says more.
set -euo pipefail
scene=$1 output=$2 frame=$SLURM_ARRAY_TASK_ID
command=(--command sparselens)
[ -z "${SPARSELENS_VIEWS-}" ] || command=(-P "$SPARSELENS_VIEWS" -- --picture)
exec blender -b "$scene" "${command[@]}" -o "$output" --frames="$frame" "${@:3}"
