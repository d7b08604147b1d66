#include "loading/ldi_lens.h"

#include "base/error.h"
#include "base/subpixels.h"
#include "deep/front_samples.h"
#include "chain/gather_windows.h"
#include "chain/picture_looks.h"

#include <fmt/format.h>

namespace sparselens {

ThinLens lens_for_ldi(OpenedLdi &in, const std::optional<Imath::V2i> &focus_pixel, int across,
                      const ToolContext &tool) {
    if (focus_pixel) {
        require_inside(*focus_pixel, in, across);
        const float z = front_depth(in.ldi, middle_subpixel(*focus_pixel, across));
        if (!(z > 0))
            throw UsageError("--focus-pixel: " + in.name +
                             " has no sample there; choose a pixel that shows something");
        in.camera.focus_distance = double(z);
        tool.say(fmt::format("the focus distance is {:g}, the depth of pixel {},{}", z, focus_pixel->x,
                             focus_pixel->y));
    }
    const ThinLens lens = in.lens();
    if (const auto warning = warning_of_wide_lens(in.camera, lens)) warn(tool, *warning);
    return lens;
}

LensLooks looks_for_ldi(const LensFile &given, Camera &camera, Imf::Header &header, const ThinLens &lens,
                        const Windows &windows, const GatherMethod *method, const ToolContext &tool) {
    if (method == &gather_methods().front()) return picture_looks(given, camera, header, lens, windows);
    if (const auto warning = warning_of_round_aperture(camera.looks, method->name)) warn(tool, *warning);
    return {};
}

} // namespace sparselens
