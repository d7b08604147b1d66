#!/bin/bash
# The tests of share/blender that .ci/run has: small pictures, no comparison with long renders. Runs as many at once as
# there are cores, since Blender mostly starts. Fails if one fails, or leaves out a part that tests/allowed-skips.txt
# does not name. Minutes.
#   bash short.sh BIN_DIR [TEST...]      the names of scripts without .sh; all of them
# Names that begin with "bpy." run in the module bpy, whose denoiser Debian 12's Blender lacks (bpy.sh).
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
bin=${1:?usage: bash short.sh BIN_DIR [TEST...]}
shift
[ $# -gt 0 ] || set -- pictures script shutter bpy.denoised extension bpy.extension mistakes apart manners window border bpy.border # the longest first
logs=$(mktemp -d)
trap 'rm -r "$logs"' EXIT
run_one() { # NAME
    local name=${1#bpy.} code=0
    local command=("$here/$name.sh" "$bin")
    [ "$name" = "$1" ] || command=("$here/bpy.sh" 4.2.0 "$bin" "$name.sh")
    bash "${command[@]}" >"$logs/$1" 2>&1 || code=$?
    [ $code -eq 0 ] || { [ $code -eq 77 ] && [ "$name" != "$1" ]; } || touch "$logs/$1.failed"
}
export -f run_one
export here bin logs
printf '%s\n' "$@" | xargs -P "$(nproc)" -I NAME bash -c 'run_one NAME'
code=0
for name; do
    echo "1/1 Testing: blender.$name"
    cat "$logs/$name"
    [ ! -e "$logs/$name.failed" ] || echo "FAIL: $name"
done | tee "$logs/all"
echo "End testing" >>"$logs/all"
! grep -q '^FAIL: ' "$logs/all" || code=1
"$here/../skips.sh" "$logs/all" || code=1
exit $code
