# Open Image Denoise on few rays over the lens, and on few samples of five views: lab/denoise on five scenes, 320x180.
# 10 CPU minutes; needs PyPI.
. "$(dirname "$0")/common.inc" "$1"
echo '| scene, rays | ray tracing | denoised | by pinhole albedo and normals | five views | five views, denoised | both: `ldi-warp --denoised` |'
echo "|---|---|---|---|---|---|---|"
for scene in fence grass mirror mist lamps; do
    [ -e "$scene.said" ] || "$(dirname "$0")/../denoise" "$bin" "$scene" "$scene" 320x180 1024 area >"$scene.new"
    [ -e "$scene.said" ] || mv "$scene.new" "$scene.said"
    cell() { sed -nE "s/^$1: ([0-9.]+) dB, worst ([0-9.]+) dB, FLIP (.+)$/ \1, \2, \3 |/p" "$scene.said" | tr -d '\n'; }
    for samples in 1 4 16 64; do
        rays=$((5 * samples))
        echo -n "| $scene, $rays |"
        for kind in exr denoised.exr pinhole.exr; do cell "drt_$rays.$kind"; done
        for kind in exr denoised.exr both; do cell "five views of $samples, $kind"; done
        echo
    done
done
