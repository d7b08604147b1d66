#include "chain/cluster_ldi.h"

#include "base/error.h"
#include "chain/file_notices.h"
#include "chain/make_ldi.h"
#include "deep/merge.h"
#include "deep/tidy.h"
#include "io/camera/camera_write.h"
#include "view/place_views.h"

#include <fmt/format.h>

#include <cmath>

namespace sparselens {

namespace {

void require_one_camera(const OpenedLdi &first, const OpenedLdi &other) {
    if (other.ldi.windows.display != first.ldi.windows.display)
        throw Error(fmt::format("{}: its display window differs from that of {}; merge pictures of one size",
                                other.name, first.name));
    require_same_subpixels(first.camera, first.name, other.camera, other.name);
    const int width = first.ldi.windows.display_width();
    const auto focal = focal_length_px(first.camera, width), others = focal_length_px(other.camera, width);
    constexpr double rounding = 1e-3; // relative, for values that other programs have written
    if (focal && others && std::abs(*others / *focal - 1) > rounding)
        throw Error(
            fmt::format("{}: its focal length is {:g} pixels, that of {} is {:g}; merge pictures of one "
                        "camera, or give `focal_length` and `sensor_width`",
                        other.name, *others, first.name, *focal));
}

// The pictures, of which there must be at least one, with their samples merged by depth (deep/merge.h).
OpenedLdi merged(std::vector<OpenedLdi> parts) {
    OpenedLdi first = std::move(parts.front());
    if (parts.size() == 1) return first;
    std::vector<Ldi> ldis;
    for (std::size_t i = 1; i < parts.size(); ++i) {
        require_one_camera(first, parts[i]);
        first.invisible += parts[i].invisible;
        ldis.push_back(std::move(parts[i].ldi));
    }
    ldis.insert(ldis.begin(), std::move(first.ldi));
    first.ldi = tidy(deep_merge(ldis));
    return first;
}

Camera camera_for(const OpenedLdi &in, const ClusterRequest &request) {
    Camera camera = camera_with_options(request.lens, in.camera);
    if (request.supersample) camera.supersample = request.supersample;
    return camera;
}

// The options for clustering. If no scale is known, inverse depth alone decides.
ClusterOptions options_for(const Camera &camera, const Windows &windows, const ClusterRequest &request,
                           bool &has_scale) {
    ClusterOptions by{.layers = request.layers};
    // `layers` alone needs no lens, because inverse depths are compared without a scale. A `tolerance` of 0 needs none
    // either.
    const double tolerance = request.tolerance.value_or(0.25);
    const bool must_know = tolerance > 0 && (request.tolerance || request.layers == 0);
    const auto scale = perceptive_scale(camera, windows, must_know);
    has_scale = scale.has_value();
    if (!scale) return by;
    by.scale = *scale;
    by.tolerance = tolerance;
    return by;
}

ClusteredLdi clustered(const OpenedLdi &in, const Camera &camera, const ClusterRequest &request,
                       Progress &progress, const Tell &tell) {
    bool has_scale = false;
    const ClusterOptions by = options_for(camera, in.ldi.windows, request, has_scale);
    ClusteredLdi out{cluster(in.ldi, by, progress), in.header, camera, in.ldi.samples(), in.invisible};
    Notice done{NoticeKind::clustered_blindly, {}, {out.samples_read, out.ldi.samples()}};
    if (has_scale) {
        done.kind = NoticeKind::clustered;
        done.values.emplace_back(out.largest_error);
    }
    tell(done);
    write_camera(out.header, out.camera);
    return out;
}

ClusteredLdi merged_and_clustered(std::vector<OpenedLdi> parts, const ClusterRequest &request,
                                  Progress &progress, const Tell &tell) {
    for (OpenedLdi &part : parts) part.camera = camera_for(part, request);
    OpenedLdi in = merged(std::move(parts));
    if (request.beauty) recolor_by(*request.beauty, "recolor", nullptr, in, tell);
    recolor_by(request.recolor, request.depth.picture, request.colour, in, tell);
    return clustered(in, in.camera, request, progress, tell);
}

} // namespace

ClusteredLdi cluster_ldi(const ClusterRequest &request, Progress &progress, const Tell &tell) {
    const std::vector<DepthOptions> depths =
        depths_of_pictures(request.depth, request.depth_files, request.inputs.size());
    std::vector<OpenedLdi> parts;
    for (std::size_t i = 0; i < depths.size(); ++i) {
        parts.push_back(open_ldi(request.inputs[i], {request.lens, depths[i]}));
        tell_samples(tell, parts.back());
    }
    return merged_and_clustered(std::move(parts), request, progress, tell);
}

ClusteredLdi cluster_ldi(std::span<const OpenedLdi *const> ldis, const ClusterRequest &request,
                         Progress &progress, const Tell &tell) {
    if (ldis.size() == 1 && !request.beauty) // a single LDI is not copied
        return clustered(*ldis[0], camera_for(*ldis[0], request), request, progress, tell);
    std::vector<OpenedLdi> parts;
    for (const OpenedLdi *ldi : ldis) parts.push_back(*ldi);
    return merged_and_clustered(std::move(parts), request, progress, tell);
}

} // namespace sparselens
