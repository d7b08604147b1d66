#!/bin/bash
# The tests of share/blender that .ci/run has: small pictures, no comparison with long renders. Fails at the first test
# that fails or is left out, and if a part is left out that tests/allowed-skips.txt does not name. Minutes.
#   bash short.sh BIN_DIR [TEST...]      the names of scripts without .sh; all of them
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
bin=${1:?usage: bash short.sh BIN_DIR [TEST...]}
shift
[ $# -gt 0 ] || set -- script extension mistakes apart pictures manners window shutter
log=$(mktemp)
trap 'rm "$log"' EXIT
for name; do
    echo "1/1 Testing: blender.$name"
    bash "$here/$name.sh" "$bin" 2>&1 || { echo "FAIL: $name" >&2 && exit 1; }
done | tee "$log"
echo "End testing" >>"$log"
"$here/../skips.sh" "$log"
