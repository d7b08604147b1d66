#include "io/recolor_ldi.h"

#include "base/error.h"
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

void require_one_frame(const OpenedLdi &ldi, const Beauty &beauty) {
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

// Drops everything else, such as depths at infinity.
Image light_and_coverage(const Image &image) {
    std::vector<Channel> kept;
    std::ranges::copy_if(image.channels, std::back_inserter(kept), is_light);
    Image result(image.windows, kept);
    for (std::size_t k = 0; k < kept.size(); ++k)
        std::ranges::copy(image.plane(find_channel(image.channels, kept[k].name)), result.plane(k).begin());
    return result;
}

// The names that channels have in files: those of light as in the beauty, the others as in the deep file.
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

std::vector<std::string> warnings_of(const Recolored &made, const std::string &deep, const Beauty &beauty) {
    std::vector<std::string> warnings;
    if (made.differ > 0)
        warnings.push_back(fmt::format("{}: its coverage differs from that of {} in {} of {} pixels; render "
                                       "both with the same objects and "
                                       "pixel filter. What it alone covers lies at infinity",
                                       beauty.name, deep, made.differ, beauty.image.windows.pixels()));
    if (made.beyond > 0)
        warnings.push_back(
            fmt::format("{}: has no colours for {} pixels of {}, which are left out; render as "
                        "much overscan as that has",
                        beauty.name, made.beyond, deep));
    return warnings;
}

} // namespace

Beauty open_beauty(const std::string &path, const PictureChoice &choice) {
    PictureChoice of_beauty = choice;
    of_beauty.depth.clear();
    of_beauty.depth_file.clear();
    return ready_beauty(read_flat_exr(path, of_beauty), path);
}

Beauty ready_beauty(FlatFile file, const std::string &path) {
    const std::string name = display_name(path);
    file.image = light_and_coverage(file.image);
    const std::vector<Channel> &channels = file.image.channels;
    bool lit = false;
    for (std::size_t k = 0; k < channels.size(); ++k) lit = lit || is_recolored(channels, k);
    if (!lit) throw Error(name + ": has no colours; give a picture with R, G and B (`recolor`)");
    // Every pixel is in front of the camera, so that its values are repaired as those of a view.
    View view{name, std::move(file.image), {}};
    view.z.assign(view.image.windows.pixels(), 1);
    const InvalidValues bad = sanitize(view);
    return {name, std::move(view.image), std::move(file.header),
            bad,  std::move(file.notes), std::move(file.warnings)};
}

std::vector<std::string> recolor(OpenedLdi &ldi, const Beauty &beauty) {
    require_one_frame(ldi, beauty);
    Recolored made = recolor(std::move(ldi.ldi), beauty.image);
    ldi.ldi = std::move(made.ldi);
    ldi.samples_read = ldi.ldi.samples();
    const KeptNames names = kept_names(ldi.ldi.channels, ldi.header, beauty.header);
    ldi.header = with_space_of(beauty.header, ldi.header);
    set_kept_names(ldi.header, names);
    ldi.header.dataWindow() = ldi.ldi.windows.data;
    write_picture_window(ldi.header, ldi.ldi.windows.data);
    if (made.infinite > 0)
        ldi.notes.push_back(
            fmt::format("{} pixels show light or coverage at infinity, where no sample is", made.infinite));
    return warnings_of(made, ldi.name, beauty);
}

} // namespace sparselens
