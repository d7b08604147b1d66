#!/bin/bash
# The tests of share/blender that .ci/run has: small pictures, no comparison with long renders. Runs as many at once as
# there are cores, since Blender mostly starts. Fails if one fails, or leaves out a part that tests/allowed-skips.txt
# does not name. Minutes.
#   bash short.sh BIN_DIR [TEST...]      the names of scripts without .sh; all of them
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
bin=${1:?usage: bash short.sh BIN_DIR [TEST...]}
shift
[ $# -gt 0 ] || set -- pictures script shutter extension mistakes apart manners window # the longest first
logs=$(mktemp -d)
trap 'rm -r "$logs"' EXIT
printf '%s\n' "$@" | xargs -P "$(nproc)" -I NAME bash -c 'bash "$0/NAME.sh" "$1" >"$2/NAME" 2>&1 || touch "$2/NAME.failed"' "$here" "$bin" "$logs"
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
