#!/bin/bash
# The add-on in a window, under Xvfb: presses buttons and Esc, and changes a field. A minute.
#   bash window.sh BIN_DIR [SCREENSHOT.png]
. "$(dirname "$0")/common.sh"
command -v xvfb-run >/dev/null || skip "needs xvfb-run (xvfb, xauth)"
PATH=$bin:$PATH
in_blender -P "$scene" -- CYCLES 320x180 save "$PWD/small.blend"
if ! xvfb-run -a blender --factory-startup --python-exit-code 1 small.blend --python-expr \
    "import bpy; bpy.app.timers.register(lambda: bpy.ops.wm.quit_blender() and None, first_interval=1)" >said 2>&1; then
    skip "Blender opens no window here ($(tail -n 1 said))"
fi
quietly xvfb-run -a -s "-screen 0 1280x1200x24" blender --factory-startup -p 0 0 1280 1200 small.blend \
    -P "$source_dir/tests/blender/window.py" -- "$(dirname "$views")" "$PWD/views" ${2:+"$2"}
grep -q 'all is as it should be' said || fail "the window: $(tail -n 5 said)"
echo "in a window: buttons, Esc and a changed focus"
