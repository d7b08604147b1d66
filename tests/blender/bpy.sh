#!/bin/bash
# Runs tests of this folder in the Blender that PyPI offers as the module bpy, version 4.2 and later.
#   bash bpy.sh PYTHON BIN_DIR TEST.sh [...]
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
python=$(cd "$(dirname "${1:?usage: bash bpy.sh PYTHON BIN_DIR TEST.sh [...]}")" && pwd)/$(basename "$1")
shims=$(mktemp -d)
trap 'rm -rf "$shims"' EXIT
printf '#!/bin/sh\nexec "%s" "%s" "$@"\n' "$python" "$here/as_blender.py" >"$shims/blender"
chmod +x "$shims/blender"
PATH=$shims:$PATH bash "$here/${3:?a test}" "$2" "${@:4}"
