#include "loading/region_file.h"

#include "base/error.h"
#include "chain/file_notices.h"
#include "deep/front_samples.h"
#include "deep/proxy.h"
#include "io/open_ldi.h"
#include "measure/regions.h"

#include <fmt/format.h>

namespace sparselens {

std::vector<std::uint8_t> regions_over(const Windows &target, const std::string &file,
                                       const OpenOptions &options, const ToolContext &tool) {
    OpenedLdi in = open_ldi(file, options);
    tell_samples(tool.tell(), in);
    const auto has_size = [&](const Windows &windows) {
        return windows.display_width() == target.display_width() &&
               windows.display_height() == target.display_height();
    };
    if (!has_size(in.ldi.windows)) in.ldi = proxy(in.ldi, in.camera.supersample.value_or(1));
    const Windows &windows = in.ldi.windows;
    if (!has_size(windows))
        throw Error(file + ": its display window differs in size from that of the reference; use a file of "
                           "the same picture");
    const ThinLens lens = in.lens();
    tool.say(fmt::format(
        "the regions are those of a lens of radius {:g}, focal length {:g} pixels, focused at {:g}",
        lens.radius, lens.focal_px, lens.focus));
    const std::vector<float> c = front_circles_of_confusion(in.ldi, lens);
    return bits_over(region_bits(c, windows.width(), windows.height(), lens.pixel_aspect), windows, target);
}

} // namespace sparselens
