#include "loading/views.h"

#include "base/in_order.h"
#include "options/lens_options.h"
#include "options/picture_options.h"

#include <optional>

namespace sparselens {

namespace {

// What is known of a view, with its pixels packed.
struct PackedFile {
    OpenedView opened; // without pixels
    PackedView view;

    explicit PackedFile(OpenedView file) : opened(std::move(file)), view(std::move(opened.view)) {}
};

void add(OpenedViews &to, PackedFile &file) {
    OpenedView &opened = file.opened;
    to.views.push_back(std::move(file.view));
    to.bad.push_back(opened.bad);
    to.notes.push_back(std::move(opened.notes));
    to.warnings.push_back(std::move(opened.warnings));
}

constexpr std::size_t not_packed_yet = 2; // views in memory: packed they take half

} // namespace

OpenedViews open_views(const ViewList &list, const OpenOptions &options) {
    std::vector<std::optional<Imath::V2d>> positions(
        list.files.size()); // read first: a mistake is said before the work
    std::vector<std::string> paths = list.files;
    for (const auto &[offset, path] : list.placed) {
        positions.push_back(view_offset(offset));
        paths.push_back(path);
    }
    const auto camera_of = [&list](const OpenedView &view) {
        Camera camera = view.camera;
        if (list.supersample) camera.supersample = list.supersample;
        return camera;
    };
    const std::vector<DepthOptions> depths =
        depths_of_pictures(options.depth, list.depth_files, paths.size());
    PackedFile centre(open_view(paths[0], {options.lens, depths[0]}));
    const Camera camera = camera_of(centre.opened);
    OpenedViews opened;
    opened.header = std::move(centre.opened.header);
    opened.depth_filtered = centre.opened.depth_filtered;
    opened.unpremultiplied = centre.opened.unpremultiplied;
    std::vector<StatedView> stated{{paths[0], camera, positions[0]}};
    add(opened, centre);
    in_order(
        paths.size() - 1, // the rim views: while one is decompressed, the depths of another are settled
        [&](std::size_t n) {
            return PackedFile(open_view(paths[n + 1], {options.lens, depths[n + 1]}, camera));
        },
        [&](std::size_t n, PackedFile next) {
            stated.push_back({paths[n + 1], camera_of(next.opened), positions[n + 1]});
            add(opened, next);
        },
        not_packed_yet);
    opened.camera = place_views(opened.views, stated);
    return opened;
}

} // namespace sparselens
