# The savings by ldi-plan: pictures of the pixels that it asks for, compared with those of whole views, at final
# quality. 4 minutes.
. "$(dirname "$0")/common.inc" "$1"
echo "| scene | whole views, dB | planned | planned, rays as many as those of so many rim views |"
echo "|---|---|---|---|"
for scene in fence grass; do
    trace $scene.truth $scene --size 640x360 --views 0 --reference 2048
    trace $scene $scene --size 640x360
    ldi-plan $scene/center.exr -o plan.json >plan.log
    rm -rf $scene.planned
    dof-trace $scene --size 640x360 --plan plan.json -o $scene.planned >/dev/null
    # shellcheck disable=SC2046
    ldi-warp $(five_views $scene) -o - 2>/dev/null | dof-gather - --quality final -o whole.exr
    ldi-warp $scene/center.exr $scene.planned/view_*.exr -o - 2>/dev/null | dof-gather - --quality final -o planned.exr
    asked=$(sed -nE 's/^in total ([0-9.]+) of a full view.*/\1/p' plan.log)
    echo "| $scene | $(db whole.exr $scene.truth/reference.exr) | $(db planned.exr $scene.truth/reference.exr) | $asked |"
done
