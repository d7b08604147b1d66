#!/bin/bash
# Submits both arrays to Slurm: views to layered depth images, and layered depth images to pictures.
#
#   submit.sh FRAMES VIEWS OUTPUT [OPTIONS OF DOF-GATHER]
#   submit.sh 1-24 /shots/010/views /shots/010/out --focus-distance 3
#
# FRAMES in the syntax of sbatch: 1-24, 1-24:2, 1,3,5-9. Prints the numbers of the two jobs. docs/farm.md says more.
set -euo pipefail
[ $# -ge 3 ] || { echo "usage: submit.sh FRAMES VIEWS OUTPUT [OPTIONS OF DOF-GATHER]" >&2; exit 2; }
here=$(cd "$(dirname "$0")" && pwd)
frames=$1 views=$2 output=$3
case $output in *\\*) echo "submit.sh: $output: sbatch takes no backslash in the name of a folder of logs" >&2; exit 2 ;; esac
mkdir -p "$output"
logs=${output//%/%%} # sbatch would replace %a
warp=$(sbatch --parsable --array="$frames" --output="$logs/warp.%a.log" "$here/warp.sh" "$views" "$output")
gather=$(sbatch --parsable --array="$frames" --dependency="aftercorr:$warp" --kill-on-invalid-dep=yes \
    --output="$logs/gather.%a.log" "$here/gather.sh" "$output" "${@:4}")
echo "$warp $gather"
