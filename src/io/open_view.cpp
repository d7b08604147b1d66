#include "io/open_view.h"

#include "base/parallel.h"
#include "deep/checks/picture_checks.h"
#include "deep/edge_depths.h"
#include "io/depth_range.h"
#include "io/exr/depth_channel.h"
#include "io/exr/exr_flat.h"
#include "io/files/file_stream.h"
#include "io/opened_camera.h"
#include "view/depth_reader.h"
#include "view/speckles.h"

namespace sparselens {

namespace {

// `camera`, with the frustum of another one if its own is unknown.
Camera with_frustum_of(const Camera &other, Camera camera) {
    if (!camera.focal_length_mm && !camera.sensor_width_mm && !camera.field) {
        camera.focal_length_mm = other.focal_length_mm;
        camera.sensor_width_mm = other.sensor_width_mm;
        camera.field = other.field;
    }
    if (!camera.principal_point) camera.principal_point = other.principal_point;
    return camera;
}

} // namespace

OpenedView open_view(const std::string &path, const OpenOptions &options, const Camera &otherwise) {
    return ready_view(read_flat_exr(path, options.depth.picture), path, options, otherwise);
}

OpenedView ready_view(FlatFile file, const std::string &path, const OpenOptions &options,
                      const Camera &otherwise) {
    OpenedView opened{.view = {display_name(path), std::move(file.image), {}},
                      .header = std::move(file.header),
                      .camera = {},
                      .bad = {},
                      .notes = std::move(file.notes),
                      .warnings = std::move(file.warnings)};
    View &view = opened.view;
    const DepthChannel depth =
        find_depth_channel(view.image.channels, options.depth.picture.depth_in_memory(), path);
    if (options.depth.picture.depth_file.empty()) opened.notes.push_back("depth: " + depth.name);
    if (depth.warning) opened.warnings.push_back(*depth.warning);
    view.z = take_depth(view.image, options.depth.picture.depth_in_memory(), path);
    const Camera own = opened_camera(opened.header, view.name, options.camera, view.image.windows);
    opened.camera = camera_with_options(options.lens, own);
    const Camera frustum = camera_with_options(options.lens, with_frustum_of(otherwise, own));
    if (const auto warning = normalized_warning(options.depth, view.z, view.image.windows.grid()))
        opened.warnings.push_back(*warning);
    const DepthReader read(view.image.windows, options.depth.meaning,
                           depth_range(options.depth, opened.header), frustum);
    parallel_ranges(view.z.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) view.z[i] = read.planar(view.z[i], i);
    });
    opened.unpremultiplied =
        !options.depth.picture.unpremultiplied && looks_unpremultiplied(fall_at_edges(flat_pixels(view)));
    opened.bad = sanitize(view);
    opened.speckles = settle_speckles(view);
    const SettledEdges settled = settle_edge_depths(view);
    opened.depth = options.depth.meaning;
    opened.depth_filtered = settled.filtered;
    if (settled.count > 0) opened.notes.push_back(edge_note(settled.count));
    return opened;
}

} // namespace sparselens
