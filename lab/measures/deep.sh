# Deep files as renderers write them, with many samples per pixel (sparselens-deep-scene, of the benchmarks): CPU
# seconds, wall seconds and peak MB, the best of three runs. 8 minutes.
. "$(dirname "$0")/common.inc" "$1"

echo "| file, step | CPU seconds | by the clock | peak MB |"
echo "|---|---|---|---|"
measure() { # SCENE WIDTH HEIGHT OPTION...
    [ -e "$1.$2.exr" ] || sparselens-deep-scene "$1" "$2" "$3" "$1.$2.exr"
    echo "| $1, $2x$3, \`oiiotool --flatten\` | $(cost oiiotool "$1.$2.exr" --flatten -o flat.exr) |"
    echo "| \`dof-gather --lens-radius 0\` | $(cost dof-gather "$1.$2.exr" --lens-radius 0 -o picture.exr) |"
    echo "| \`dof-gather\` | $(cost dof-gather "$1.$2.exr" "${@:4}" -o picture.exr) |"
}
for scene in dense hair volume; do measure $scene 512 270 --lens-radius 0.28125; done
measure dense 2048 1080 --lens-radius 0.0703125
