# Shared by the tests of share/blender, which source it; they are run as `bash SCRIPT BIN_DIR [...]`.
. "$(dirname "${BASH_SOURCE[0]}")/../tools/check.sh"
command -v blender >/dev/null || skip "needs blender"
command -v oiiotool >/dev/null || skip "needs oiiotool (openimageio-tools)"
scene=$source_dir/tests/blender/scene.py
variants=$source_dir/tests/blender/variants.py
views=$source_dir/share/blender/sparselens_views.py

# Views of the picture's own size and pixels, whatever the scene would gain from others.
plain=(--overscan 0 --supersample 1)

decibels() { "$bin/dof-compare" "$1" "$2" | awk '$1 == "psnr_tonemapped" { print $2 }'; }
# better A B BY WHAT: A is at least B + BY; all in dB.
better() { awk -v a="$1" -v b="$2" -v by="$3" 'BEGIN { exit !(a >= b + by) }' || fail "$4: $1 dB against $2, not $3 better"; }
# alike A B BY: the two pictures differ by at most BY dB.
alike() { better "$(decibels "$1" "$2")" "$3" 0 "$1 and $2"; }
unlike() { better "$3" "$(decibels "$1" "$2")" 0 "$1 and $2 are too much alike"; }
quietly() { "$@" >said 2>&1 || fail "$*: $(tail -n 5 said)"; }
in_blender() { quietly blender --python-exit-code 1 -b "$@"; }
# EEVEE needs OpenGL, and mostly a display.
in_eevee() {
    if command -v xvfb-run >/dev/null; then
        quietly xvfb-run -a blender --python-exit-code 1 -b "$@"
    else
        in_blender "$@"
    fi
}
# eevee_runs SCENE: whether Blender's own render of SCENE.blend by EEVEE works here; if not, says why.
eevee_runs() {
    if (in_eevee "$1.blend" -P "$variants" -- render 1 1 1 "$PWD/probe.####.exr") 2>probe.log && [ -s probe.0001.exr ]; then
        rm probe.0001.exr
    else
        echo "skipped: EEVEE, which does not run here; xvfb and libgl1-mesa-dri may be missing ($(tail -n 1 probe.log))"
        return 1
    fi
}
# variant FROM KIND: makes KIND.blend of FROM.blend.
variant() { in_blender "$1.blend" -P "$variants" -- "$2" "$PWD/$2.blend"; }
# each_variant FROM KIND...: makes KIND.blend of FROM.blend, for each of them.
each_variant() { in_blender "$1.blend" -P "$variants" -- each "${@:2}"; }
# defocused OUT CENTER VIEW...: the shell recipe.
defocused() {
    local out=$1
    shift
    "$bin/ldi-warp" "$@" -o - | "$bin/ldi-cluster" - -o - | "$bin/dof-gather" - -o "$out"
}
