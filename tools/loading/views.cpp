#include "loading/views.h"

#include "base/in_order.h"
#include "options/picture_options.h"
#include "view/place_views.h"

#include <optional>

namespace sparselens {

namespace {

void add(OpenedViews &to, OpenedView &opened) {
    to.views.push_back(std::move(opened.view));
    to.bad.push_back(opened.bad);
    to.notes.push_back(std::move(opened.notes));
    to.warnings.push_back(std::move(opened.warnings));
}

} // namespace

OpenedViews open_views(const ViewList &list, const OpenOptions &options) {
    std::vector<std::optional<Imath::V2d>> positions(
        list.files.size()); // read first: a mistake is said before the work
    std::vector<std::string> paths = list.files;
    for (const auto &[offset, path] : list.placed) {
        positions.push_back(view_offset(offset));
        paths.push_back(path);
    }
    OpenedView centre = open_view(paths[0], options);
    const Camera camera = centre.camera;
    OpenedViews opened;
    opened.header = std::move(centre.header);
    opened.depth_filtered = centre.depth_filtered;
    std::vector<StatedView> stated{{paths[0], camera, positions[0]}};
    add(opened, centre);
    in_order(
        paths.size() - 1, // the rim views: while one is decompressed, the depths of another are settled
        [&](std::size_t n) { return open_view(paths[n + 1], options, camera); },
        [&](std::size_t n, OpenedView next) {
            stated.push_back({paths[n + 1], next.camera, positions[n + 1]});
            add(opened, next);
        });
    opened.camera = place_views(opened.views, stated);
    return opened;
}

} // namespace sparselens
