#!/bin/bash
# Puts deliberate faults in, one at a time, and says which tests catch each. A fault that none catches is a hole in the
# tests.
#
#   tests/mutations.sh [NAME...]     all, or those of these names
#
# Works on a copy in build-mutations/; exit 1 where a fault is not caught.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
exec </dev/null
source=$PWD copy=$PWD/build-mutations

# NAME | FILE | WHAT (basic regular expression of one line) | INSTEAD
faults=$(
    cat <<'END'
coc-sign|src/lens/thin_lens.cpp|((z - lens.focus) / z)|((lens.focus - z) / z)
coc-cancels|src/lens/thin_lens.cpp|(rf \/ lens.focus) \* ((z - lens.focus) \/ z)|rf * (1 / lens.focus - 1 / z)
coc-no-sky|src/lens/thin_lens.cpp|if (std::isinf(z)) return rf / lens.focus;|
half-pixel-off|src/dof/lens/sample_blocks.cpp|float(x) + 0.5f + place.dx|float(x) + place.dx
aspect-dropped|src/lens/lens_samples.cpp|-u.y \* pixel_aspect|-u.y * (pixel_aspect > 0 ? 1 : 2)
alpha-dropped|src/dof/lens/lens_tile_partial.cpp|1 - samples_.alpha\[i\]|1.0f
layers-too-far|src/dof/merge_layers.cpp|<= tolerance_)) return false|<= 4 * tolerance_)) return false
not-renormalised|src/dof/lens/lens_tile.cpp|sums_\[at\] / known|sums_[at] / total_
weight-dropped|src/warp/warp.cpp|out.weight.push_back(float(count))|out.weight.push_back(1.0f)
texture-is-noise|src/plan/noise.cpp|gaussian >= least_gaussian \* count|gaussian >= 0
view-in-part-shifts|src/warp/warp.cpp|emit_mean(balanced(surface.samples), out);|emit_mean(surface.samples, out);
view-moved-wrong-way|src/view/view_mapping.cpp|V2d(focal_px \* position.x|V2d(-focal_px * position.x
view-y-wrong-way|src/view/view_mapping.cpp|-focal_px \* position.y|focal_px * position.y
view-approach-wrong-way|src/view/view_mapping.cpp|approach_(view.forward|approach_(-view.forward
reproject-truncates|src/warp/reproject.cpp|cell_x = std::floor(x)|cell_x = std::trunc(x)
unsorted|src/deep/tidy.cpp|return a.z != b.z ? a.z < b.z : a.z_back < b.z_back;|return a.index < b.index;
float-accumulator|src/deep/flatten.cpp|sum += transmittance \* ldi.values\[k\]\[i\];|sum = double(float(sum + transmittance * ldi.values[k][i]));
half-hidden-lamp|src/warp/silhouettes.cpp|if (!mix) return with_one_pixel(x, y, mixture.near_depth, f);|if (!mix) return {};
small-lamp-impure|src/warp/silhouettes.cpp|if (const Imath::V3d c = colour_of(i); (c - result).dot(contrast) > 0) result = c;|(void)contrast;
strands-not-seen|src/warp/mixed/wisps.cpp|return std::min(along, down) >= many_jumps;|return std::min(along, down) > 4 * many_jumps;
mixed-left-whole|src/warp/warp.cpp|options.split_silhouettes ? options.surface_px : 0|options.split_silhouettes ? 2 * options.surface_px : 0
cluster-weights|src/deep/cluster.cpp|terms\[t\].coefficient /= weights|(void)weights
lamp-shadows-square|src/dof/footprints/footprint.cpp|if (n == none) continue;|(void)n; continue;
lamp-light-as-averaged|src/warp/lamps/lamp_light.cpp|change.factor = 1 + (\*wanted - all) / of_lamp;|change.factor = 1;
lamp-depth-as-rendered|src/warp/lamps/lamp_depths.cpp|if (!shown.empty()) view_.z\[shown.front()\] = float(1 / inverse_z);|(void)inverse_z;
lamps-opaque-alone|src/dof/lens/highlights.cpp|i < block.end; ++i) visit|i < block.opaque_end; ++i) visit
lamp-counted-twice|src/dof/lens/highlights.cpp|colours.at(k, f.sample) \*= 1 - f.share;|
light-made|src/dof/lens/sharpen.cpp|{n.sample\[k\], -shared}|{n.sample[k], 0}
bad-alpha-kept|src/deep/sanitize.cpp|return v >= 0 \&\& v <= 1;|return v == v;
nan-kept|src/deep/sanitize.cpp|return std::abs(v) <= 1e34f;|return !(std::abs(v) < 0);
memory-unlimited|src/io/files/memory_limit.cpp|if (bytes <= allowed) return;|if (bytes <= allowed * 1e9) return;
half-infinite|src/io/exr/exr_common.cpp|std::clamp(from\[i\], -largest, largest)|std::clamp(from[i], -2 * largest, 2 * largest)
bands-too-narrow|src/dof/gather_rows.cpp|std::ceil(spread + goes_on)|std::ceil(0 * spread * goes_on)
packed-to-halves|src/deep/packed/packed_rows.cpp|if (is_half(values\[i\])) continue;|if (values[i] < 1) continue;
gpu-warp-surface-order|src/gpu/warp/warp_surfaces.comp|(marks\[i\].x == 0) == (pass == 0)|true
gpu-warp-prefix-sum|src/gpu/warp/warp_scan_add.comp|sums\[i / block_size\]|0u
wrong-samples-read|src/io/exr/exr_deep_part.cpp|ldi.begin\[first + i\]|ldi.begin[first]
END
)

while IFS='|' read -r name file what instead; do
    sed "s|$what|$instead|" "$file" | cmp -s - "$file" && { echo "$name: $file has no such line any more"; exit 1; }
done <<<"$faults"

rm -rf "$copy"
mkdir "$copy"
git ls-files -z | xargs -0 cp --parents -t "$copy"
cd "$copy"
cmake --preset release --log-level=WARNING -DSPARSELENS_BENCHMARKS=OFF -DSPARSELENS_WERROR=OFF
ninja -C build -j "$(nproc)" sparselens-tests dof-stress >build.log || { tail -n 20 build.log; exit 1; }

# The unit tests but those of the ray tracer; where none fails, dof-stress.
failing_tests() {
    local failing
    failing=$(timeout 300 build/bin/sparselens-tests --gtest_brief=1 --gtest_filter='-Trac*:Render*:Scenes*:Shading*' 2>&1 |
        sed -nE 's/^\[  FAILED  \] ([A-Za-z0-9_/.]+).*/\1/p' | sort -u)
    [ -n "$failing" ] || failing=$(timeout 100 build/bin/dof-stress 2>/dev/null | sed -nE 's/^([^ ]*) .*FAIL$/dof-stress:\1/p')
    [ -z "$failing" ] || echo "$failing"
}
[ -z "$(failing_tests)" ] || { echo "tests fail without any fault"; failing_tests; exit 1; }

missed=0
while IFS='|' read -r name file what instead; do
    [ $# -eq 0 ] || [[ " $* " == *" $name "* ]] || continue
    sed -i "s|$what|$instead|" "$file"
    if ! ninja -C build -j "$(nproc)" sparselens-tests dof-stress >build.log 2>&1; then
        echo "$name: does not compile"
        tail -n 5 build.log
        missed=$((missed + 1))
    else
        caught=$(failing_tests)
        [ -n "$caught" ] || missed=$((missed + 1))
        echo "$name ($file): ${caught:+$(wc -l <<<"$caught") fail: }$(head -n 4 <<<"${caught:-NOT CAUGHT}" | paste -sd ' ')"
    fi
    cp -p "$source/$file" "$file"
    touch "$file"
done <<<"$faults"
exit $((missed > 0))
