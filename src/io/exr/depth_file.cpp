#include "io/exr/depth_file.h"

#include "base/error.h"
#include "io/exr/depth_channel.h"
#include "io/exr/exr_common.h"

#include <fmt/format.h>

#include <algorithm>

namespace sparselens {

namespace {

// The depth channel. A file that holds only depth may give it any name: Y, or a grey R, G and B.
DepthChannel depth_of(const std::vector<Channel> &channels, const std::string &asked,
                      const std::string &path) {
    if (asked.empty() && !has_depth_channel(channels, asked)) {
        const std::size_t red = find_channel(channels, "R");
        if (channels.size() == 1 || red != npos)
            return find_depth_channel(channels, channels[channels.size() == 1 ? 0 : red].name, path);
    }
    return find_depth_channel(channels, asked, path);
}

// Adds the plane Z to the picture, all 0.
std::span<float> new_depth(Image &image) {
    std::size_t k = find_channel(image.channels, "Z");
    if (k == npos) {
        k = image.channels.size();
        image.channels.push_back({"Z", PixelType::float32, ChannelKind::data});
        image.values.resize(image.channels.size() * image.windows.pixels());
    }
    const std::span<float> plane = image.plane(k);
    std::ranges::fill(plane, 0.0f);
    return plane;
}

} // namespace

void put_depth_of_file(FlatFile &picture, const std::string &path, const PictureChoice &choice) {
    const std::string &name = choice.depth_file;
    const bool stereo = !choice.stereo_view.empty() && !stereo_views(name).empty();
    const FlatFile file = read_flat_exr(name, {.stereo_view = stereo ? choice.stereo_view : std::string()});
    const Windows &from = file.image.windows, &to = picture.image.windows;
    if (from.display != to.display || from.pixel_aspect != to.pixel_aspect)
        throw Error(
            fmt::format("{}: its display window or its pixel aspect ratio is not that of {}, whose depth "
                        "it is to hold (`depth_file`)",
                        display_name(name), display_name(path)));
    const DepthChannel depth = depth_of(file.image.channels, choice.depth, name);
    const auto values = file.image.plane(find_channel(file.image.channels, depth.name));
    const std::span<float> plane = new_depth(picture.image);
    const Imath::Box2i both(
        {std::max(from.data.min.x, to.data.min.x), std::max(from.data.min.y, to.data.min.y)},
        {std::min(from.data.max.x, to.data.max.x), std::min(from.data.max.y, to.data.max.y)});
    for (int y = both.min.y; y <= both.max.y; ++y)
        for (int x = both.min.x; x <= both.max.x; ++x) plane[to.index(x, y)] = values[from.index(x, y)];
    picture.notes.push_back(fmt::format("depth: {} of {}", depth.name, display_name(name)));
    if (depth.warning) picture.warnings.push_back(display_name(name) + ": " + *depth.warning);
}

} // namespace sparselens
