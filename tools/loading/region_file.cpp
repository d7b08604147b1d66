#include "loading/region_file.h"

#include "base/error.h"
#include "io/open_ldi.h"
#include "loading/notices.h"
#include "measure/regions.h"

namespace sparselens {

std::vector<std::uint8_t> regions_over(const Windows &target, const std::string &file,
                                       const OpenOptions &options, const ToolContext &tool) {
    const OpenedLdi in = open_ldi(file, options);
    say_samples(tool, in);
    warn_of_invalid_values(tool, file, in.bad);
    const Windows &windows = in.ldi.windows;
    if (windows.display_width() != target.display_width() ||
        windows.display_height() != target.display_height())
        throw Error(file + ": the display window differs in size from the reference's");
    const ThinLens lens = in.lens();
    tool.say("regions by a lens of radius " + std::to_string(lens.radius) + ", focal length " +
             std::to_string(lens.focal_px) + " pixels, focused at " + std::to_string(lens.focus));
    const std::vector<float> c = front_circles_of_confusion(in.ldi, lens);
    return bits_over(region_bits(c, windows.width(), windows.height(), lens.pixel_aspect), windows, target);
}

} // namespace sparselens
