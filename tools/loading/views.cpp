#include "loading/views.h"

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
    OpenedViews opened;
    std::vector<StatedView> stated;
    for (std::size_t i = 0; i < paths.size(); ++i) {
        OpenedView next = open_view(paths[i], options, i > 0 ? stated[0].camera : Camera{});
        stated.push_back({paths[i], next.camera, positions[i]});
        if (i == 0) {
            opened.header = std::move(next.header);
            opened.depth_filtered = next.depth_filtered;
        }
        add(opened, next);
    }
    opened.camera = place_views(opened.views, stated);
    return opened;
}

} // namespace sparselens
