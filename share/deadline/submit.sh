#!/bin/bash
# Submits two jobs to Deadline: views to layered depth images, and layered depth images to pictures. A frame of the
# second waits for the same frame of the first.
#
#   submit.sh FRAMES VIEWS OUTPUT [OPTIONS OF DOF-GATHER]
#   submit.sh 1-24 /shots/010/views /shots/010/out --focus-distance 3
#
# FRAMES in Deadline's syntax: 1-24, 1-24x2, 1,3,5-9. VIEWS has center.####.exr, view_0.####.exr, ... Prints the ids of
# the jobs. docs/farm.md says more.
set -euo pipefail
[ $# -ge 3 ] || { echo "usage: submit.sh FRAMES VIEWS OUTPUT [OPTIONS OF DOF-GATHER]" >&2; exit 2; }
frames=$1 views=$2 output=$3
first=$(printf %04d "$(expr "$frames" : '\(-\{0,1\}[0-9]*\)')")
rim=("$views"/view_*."$first".exr)
[ -e "${rim[0]}" ] || { echo "submit.sh: ${rim[0]}: there is no such view: render the views of frame $first first" >&2; exit 1; }
files=$(mktemp -d)
trap 'rm -rf "$files"' EXIT

# submit NAME DEPENDENCY COMMAND...: prints the id.
submit() {
    local words=() word said
    for word in "${@:4}"; do
        case $word in *'"'* | *$'\n'* | *'<'*) echo "submit.sh: $word: Deadline takes no \", < or line break here" >&2; exit 2 ;; esac
        words+=("<QUOTE>$word<QUOTE>")
    done
    printf '%s\n' Plugin=CommandLine "Name=sparselens $1" "Frames=$frames" ChunkSize=1 "OutputDirectory0=$output" \
        ${2:+"JobDependencies=$2" IsFrameDependent=true} >"$files/job"
    printf '%s\n' "Executable=$3" "Arguments=${words[*]} --frames=<STARTFRAME>" Shell=default ShellExecute=False \
        SingleFramesOnly=True >"$files/plugin"
    said=$(deadlinecommand "$files/job" "$files/plugin") || exit
    case $said in *JobID=*) sed -n 's/^JobID=//p' <<<"$said" ;; *) echo "submit.sh: $said" >&2; exit 1 ;; esac
}
warp=$(submit warp "" ldi-warp "$views/center.####.exr" "${rim[@]/%.????.exr/.####.exr}" -o "$output/ldi.####.exr")
gather=$(submit gather "$warp" dof-gather "$output/ldi.####.exr" -o "$output/picture.####.exr" "${@:4}")
echo "$warp $gather"
