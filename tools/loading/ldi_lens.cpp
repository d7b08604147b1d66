#include "loading/ldi_lens.h"

#include "base/error.h"
#include "deep/front_depth.h"

#include <ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>

namespace sparselens {

namespace {

double widest_view(const Camera &camera) {
    double widest = 0;
    for (const Imath::V2d &point : camera.lens_points) widest = std::max(widest, point.length());
    return widest;
}

} // namespace

ThinLens lens_for_ldi(OpenedLdi &in, const std::optional<Imath::V2i> &focus_pixel, const ToolContext &tool) {
    if (focus_pixel) {
        const float z = front_depth(in.ldi, *focus_pixel);
        if (!(z > 0))
            throw UsageError("--focus-pixel: " + in.name +
                             " has no sample there; choose a pixel that shows something");
        in.camera.focus_distance = double(z);
        tool.say(fmt::format("the focus distance is {:g}, the depth of pixel {},{}", z, focus_pixel->x,
                             focus_pixel->y));
    }
    const ThinLens lens = in.lens();
    const double widest = widest_view(in.camera);
    if (widest > 0 && lens.radius > 1.001 * widest)
        warn(tool, "the aperture is larger than the one the views were rendered for; what it sees beyond "
                   "them is unknown");
    return lens;
}

LensLooks looks_for_ldi(OpenedLdi &in, const LensFile &given, const ThinLens &lens, const Windows &windows,
                        const GatherMethod *method, const ToolContext &tool) {
    const LookValues &said = in.camera.looks;
    if (method != &gather_methods().front()) {
        if (said.blades.value_or(0) != 0 || said.squeeze.value_or(1) != 1)
            warn(tool,
                 fmt::format("the aperture is taken for round, as --method {} knows no other", method->name));
        return {};
    }
    in.camera.looks = look_values_over(given.values, said);
    if (!given.name.empty()) in.header.insert("lensModel", Imf::StringAttribute(given.name));
    return resolve_looks(in.camera.looks, in.camera, lens, windows);
}

} // namespace sparselens
