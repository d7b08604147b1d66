#include "io/open_view.h"

#include "base/error.h"
#include "base/parallel.h"
#include "deep/checks/picture_checks.h"
#include "deep/mixed_pixels.h"
#include "io/exr/exr_channels.h"
#include "io/exr/exr_header.h"
#include "io/files/file_stream.h"
#include "view/flat_pixels.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>

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
    return prepare_view(read_flat_exr(path, options.depth.picture), path, options, otherwise);
}

OpenedView prepare_view(FlatFile file, const std::string &path, const OpenOptions &options,
                        const Camera &otherwise) {
    OpenedView opened;
    opened.header = std::move(file.header);
    opened.notes = std::move(file.notes);
    opened.warnings = std::move(file.warnings);
    View &view = opened.view;
    view.name = display_name(path);
    view.image = std::move(file.image);
    const DepthChannel depth =
        find_depth_channel(view.image.channels, options.depth.picture.depth_in_memory(), path);
    if (options.depth.picture.depth_file.empty()) opened.notes.push_back("depth: " + depth.name);
    if (depth.warning) opened.warnings.push_back(*depth.warning);
    view.z = take_depth(view.image, options.depth.picture.depth_in_memory(), path);
    const Camera own = opened_camera(opened.header, view.name, options.camera, view.image.windows);
    opened.camera = camera_with_options(options.lens, own);
    const Camera frustum = camera_with_options(options.lens, with_frustum_of(otherwise, own));
    if (const auto warning = normalized_warning(options.depth, view.z, view.image.windows.grid().array()))
        opened.warnings.push_back(*warning);
    const DepthReader read(view.image.windows, options.depth.meaning,
                           depth_range(options.depth, opened.header), frustum);
    parallel_ranges(view.z.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) view.z[i] = read.planar(view.z[i], i);
    });
    opened.unpremultiplied =
        !options.depth.picture.unpremultiplied && looks_unpremultiplied(fall_at_edges(flat_pixels(view)));
    opened.bad = sanitize(view);
    opened.speckles = repair_speckles(view);
    const RepairedEdges repaired = repair_edge_depths(view);
    opened.depth = options.depth.meaning;
    opened.depth_filtered = repaired.filtered;
    if (repaired.count > 0) opened.notes.push_back(edge_note(repaired.count));
    return opened;
}

namespace {

std::optional<double> number_in(const Imf::Header &header, std::initializer_list<const char *> names) {
    const std::vector<HeaderValue> values = header_values(header);
    for (const char *name : names)
        if (const HeaderValue *found = find_value(values, name); found && found->numbers.size() == 1)
            return found->numbers[0];
    return {};
}

bool are_inverse(const ArrayGrid &grid, std::span<const float> depths) {
    const Image no_channels(windows_of_size(grid.width(), grid.height()), {});
    return looks_inverse(slopes_of_depth({"", no_channels, {depths.begin(), depths.end()}}));
}

} // namespace

DepthRange depth_range(const DepthOptions &options, const Imf::Header &header) {
    const bool hyperbolic = options.meaning == DepthMeaning::hyperbolic;
    if (options.meaning != DepthMeaning::normalized && !hyperbolic) {
        if (options.far == 0) throw UsageError("`far` is not a depth above 0");
        if (options.near)
            throw UsageError("`near` works with `depth=normalized` and `depth=hyperbolic` only");
        return {0, options.far.value_or(DepthRange().far)};
    }
    const char *word = hyperbolic ? "hyperbolic" : "normalized";
    const auto near = options.near ? options.near : number_in(header, {"near", "nearClip", "clipNear"});
    const auto far = options.far ? options.far : number_in(header, {"far", "farClip", "clipFar"});
    if (!near || !far)
        throw UsageError(fmt::format("`depth={}`: which depth is {} is unknown: give {}", word,
                                     near ? "1" : (far ? "0" : "0 and which is 1"),
                                     near ? "`far`" : (far ? "`near`" : "`near` and `far`")));
    const auto [least, most] = std::minmax(*near, *far);
    const bool from_0 =
        least == 0 && !hyperbolic && std::isfinite(most); // a linear depth may begin at the camera
    if (!((least > 0 || from_0) && most > least))
        throw UsageError(fmt::format("`depth={}`: `near` and `far` must be above 0 and not the same (with "
                                     "`depth=normalized`, the nearer one may be 0): they are {:g} and {:g}",
                                     word, *near, *far));
    return {*near, *far};
}

std::optional<std::string> normalized_warning(const DepthOptions &options, std::span<const float> depths) {
    if (options.meaning != DepthMeaning::planar || depths.empty()) return {};
    const auto [least, most] = std::ranges::minmax(depths);
    if (!(least >= 0 && least < 1 && most == 1)) return {};
    return "its depths end at exactly 1, as normalised ones do: if they are, give `depth=normalized` with "
           "`near` and `far`, or `depth=hyperbolic` if they are those of a depth buffer";
}

std::optional<std::string> normalized_warning(const DepthOptions &options, std::span<const float> depths,
                                              const ArrayGrid &grid) {
    if (options.meaning == DepthMeaning::planar && looks_white_near(grid, depths) &&
        !are_inverse(grid, depths)) // which has another warning
        return "its depths lie from 0 to 1 and seem to be white near: if they are, give `depth=normalized` "
               "with "
               "`near`, the depth of 0, which is the farther one, and `far`, that of 1";
    return normalized_warning(options, depths);
}

} // namespace sparselens
