#include "chain/regions.h"

#include "base/error.h"
#include "deep/flatten.h"
#include "deep/proxy.h"
#include "measure/regions.h"

#include <optional>

namespace sparselens {

std::vector<std::uint8_t> regions_over(const Windows &target, const OpenedLdi &in, const LensValues &values,
                                       const Notify &notify) {
    const auto has_size = [&](const Windows &windows) {
        return windows.display_width() == target.display_width() &&
               windows.display_height() == target.display_height();
    };
    std::optional<Ldi> smaller;
    if (!has_size(in.ldi.windows)) smaller = proxy(in.ldi, in.camera.supersample.value_or(1));
    const Ldi &ldi = smaller ? *smaller : in.ldi;
    if (!has_size(ldi.windows))
        throw Error(in.name +
                    ": its display window differs in size from that of the reference; use a file of "
                    "the same picture");
    const ThinLens lens = resolve_lens(camera_with_options(values, in.camera), ldi.windows);
    notify({.kind = NoticeKind::regions, .values = {lens.radius, lens.focal_px, lens.focus}});
    const std::vector<float> c = front_circles_of_confusion(ldi, lens);
    return bits_over(region_bits(c, ldi.windows.width(), ldi.windows.height(), lens.pixel_aspect),
                     ldi.windows, target);
}

std::vector<std::uint8_t> regions_over(const Windows &target, const std::string &file,
                                       const OpenOptions &options, const Notify &notify) {
    const OpenedLdi in = open_ldi(file, options);
    notify_samples(notify, in);
    return regions_over(target, in, options.lens, notify);
}

} // namespace sparselens
