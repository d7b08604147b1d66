#include "chain/recolor_ldi.h"

#include "base/error.h"
#include "chain/file_notices.h"
#include "chain/flat_light.h"
#include "deep/recolor.h"
#include "io/camera/camera_write.h"
#include "io/display/stated_space.h"
#include "io/exr/kept_names.h"
#include "io/files/file_stream.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace sparselens {

namespace {

void require_colours(std::span<const Channel> channels, const std::string &name) {
    for (std::size_t k = 0; k < channels.size(); ++k)
        if (is_recolored(channels, k)) return;
    throw Error(name + ": has no colours; give a picture with R, G and B (`recolor`)");
}

void require_one_frame(const OpenedLdi &ldi, const FlatLight &beauty) {
    const Windows &deep = ldi.ldi.windows, &flat = beauty.image.windows;
    if (deep.display != flat.display)
        throw Error(
            fmt::format("{}: its display window differs from that of {}; give the picture of the same "
                        "frame and size (`recolor`)",
                        beauty.name, ldi.name));
    if (deep.pixel_aspect != flat.pixel_aspect)
        throw Error(fmt::format("{}: its pixel aspect ratio is {:g}, that of {} is {:g}; give the picture of "
                                "the same camera (`recolor`)",
                                beauty.name, flat.pixel_aspect, ldi.name, deep.pixel_aspect));
    if (!deep.data.intersects(flat.data))
        throw Error(
            fmt::format("{}: its data window has no pixel in common with that of {}; give the picture "
                        "of the same frame (`recolor`)",
                        beauty.name, ldi.name));
}

// The names that channels get in files: those of light as in the beauty, the others as in the deep file.
KeptNames kept_names(const std::vector<Channel> &channels, const Imf::Header &deep, const Imf::Header &flat) {
    const std::vector<Channel> of_deep = by_kept_names(channels, deep),
                               of_flat = by_kept_names(channels, flat);
    KeptNames kept;
    for (std::size_t k = 0; k < channels.size(); ++k) {
        const std::string &name = (is_recolored(channels, k) ? of_flat : of_deep)[k].name;
        if (name != channels[k].name) kept[channels[k].name] = name;
    }
    return kept;
}

void tell_recolored(const Recolored &made, const std::string &deep, const FlatLight &beauty,
                    const Tell &tell) {
    if (made.differ > 0)
        tell({NoticeKind::coverage_differs, beauty.name, {deep, made.differ, beauty.image.windows.pixels()}});
    if (made.beyond > 0) tell({NoticeKind::without_colours, beauty.name, {deep, made.beyond}});
    if (made.infinite > 0) tell({NoticeKind::light_at_infinity, beauty.name, {made.infinite}});
}

} // namespace

void recolor_by(FlatFile file, const std::string &path, const ColourOptions *colour, OpenedLdi &ldi,
                const Tell &tell) {
    const FlatLight beauty = light_of(std::move(file), path, colour, tell);
    require_colours(beauty.image.channels, beauty.name);
    require_one_frame(ldi, beauty);
    Recolored made = recolor(std::move(ldi.ldi), beauty.image);
    ldi.ldi = std::move(made.ldi);
    ldi.samples_read = ldi.ldi.samples();
    const KeptNames names = kept_names(ldi.ldi.channels, ldi.header, beauty.header);
    ldi.header = with_space_of(beauty.header, ldi.header);
    set_kept_names(ldi.header, names);
    ldi.header.dataWindow() = ldi.ldi.windows.data;
    write_picture_window(ldi.header, ldi.ldi.windows.data);
    tell_recolored(made, ldi.name, beauty, tell);
    tell_layers(tell, beauty.name, ldi.ldi.channels);
}

void recolor_by(const std::string &path, const PictureChoice &choice, const ColourOptions &colour,
                OpenedLdi &ldi, const Tell &tell) {
    if (path.empty()) return;
    tell({NoticeKind::reading, path});
    recolor_by(read_flat_exr(path, without_depth(choice)), path, &colour, ldi, tell);
}

} // namespace sparselens
