#!/bin/bash
# Runs tests of this folder in the Blender that PyPI offers as the module bpy, version 4.2 and later. A version, such as
# 4.2.0, is installed first into a folder of the user's cache (1.6 GB), for Debian's Python; later runs find it there.
#   bash bpy.sh PYTHON|VERSION BIN_DIR TEST.sh [...]
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
python=${1:?usage: bash bpy.sh PYTHON|VERSION BIN_DIR TEST.sh [...]}
if [[ $python =~ ^[0-9.]+$ ]]; then
    made=${XDG_CACHE_HOME:-$HOME/.cache}/sparselens/bpy-$python
    mkdir -p "$made"
    exec {lock}>"$made/lock" # for tests that begin together
    flock "$lock"
    if [ ! -e "$made/done" ]; then
        /usr/bin/python3 -m venv --clear "$made/env"
        "$made"/env/bin/pip -q --disable-pip-version-check install --no-cache-dir --retries 1 "bpy==$python" >"$made/log" 2>&1 || {
            echo "skipped: bpy $python: PyPI cannot be reached, or has no wheel for this Python"
            exit 77
        }
        touch "$made/done"
    fi
    exec {lock}>&-
    python=$made/env/bin/python
fi
python=$(cd "$(dirname "$python")" && pwd)/$(basename "$python")
shims=$(mktemp -d)
trap 'rm -rf "$shims"' EXIT
printf '#!/bin/sh\nexec "%s" "%s" "$@"\n' "$python" "$here/as_blender.py" >"$shims/blender"
chmod +x "$shims/blender"
PATH=$shims:$PATH bash "$here/${3:?a test}" "$2" "${@:4}"
