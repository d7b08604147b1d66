#include "loading/gather_windows.h"

#include "base/error.h"
#include "deep/pad.h"
#include "deep/proxy.h"
#include "io/camera/camera_read.h"
#include "io/files/memory_limit.h"

#include <fmt/format.h>

#include <algorithm>

namespace sparselens {

namespace {

Imath::Box2i common(const Imath::Box2i &a, const Imath::Box2i &b, const char *what) {
    const Imath::Box2i box({std::max(a.min.x, b.min.x), std::max(a.min.y, b.min.y)},
                           {std::min(a.max.x, b.max.x), std::min(a.max.y, b.max.y)});
    if (box.isEmpty()) throw UsageError(fmt::format("{} contains no pixel of the picture", what));
    return box;
}

// `data` grown by `reach` where there is display window beyond it.
Imath::Box2i grown(const Imath::Box2i &data, const Imath::V2i &reach, const Imath::Box2i &display) {
    return {{std::min(data.min.x, std::max(display.min.x, data.min.x - reach.x)),
             std::min(data.min.y, std::max(display.min.y, data.min.y - reach.y))},
            {std::max(data.max.x, std::min(display.max.x, data.max.x + reach.x)),
             std::max(data.max.y, std::min(display.max.y, data.max.y + reach.y))}};
}

// A few near samples in a huge display window may require a picture of gigabytes.
void check_growth(const OpenedLdi &in, const Ldi &ldi, const Imath::Box2i &window) {
    const double pixels =
        (double(window.max.x) - window.min.x + 1) * (double(window.max.y) - window.min.y + 1);
    const std::size_t channels = ldi.channels.size() * sizeof(float), offset = sizeof(ldi.begin[0]);
    check_memory(in.name, pixels * double(channels + offset),
                 ldi.samples() * channels + ldi.windows.pixels() * offset);
}

} // namespace

GatherWindows gather_windows(const WindowOptions &options, const OpenedLdi &in, ThinLens &lens) {
    lens.focal_px /= options.proxy;
    GatherWindows frame{reduced(read_picture_window(in.header), options.proxy), {}, {}};
    if (options.proxy > 1) frame.changed = proxy(in.ldi, options.proxy);
    const auto made = [&]() -> const Ldi & { return frame.changed ? *frame.changed : in.ldi; };
    if (options.overscan == OutputOverscan::grow && lens.radius > 0) {
        frame.gathered = grown(frame.gathered, largest_reach(made(), lens), made().windows.display);
        check_growth(in, made(), frame.gathered);
        frame.changed = padded(made(), frame.gathered);
    }
    frame.written = frame.gathered;
    if (options.overscan == OutputOverscan::crop)
        frame.written = common(frame.written, made().windows.display, "--overscan crop: the display window");
    if (options.region)
        frame.written = common(frame.written, reduced(*options.region, options.proxy), "--region");
    return frame;
}

} // namespace sparselens
