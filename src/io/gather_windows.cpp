#include "io/gather_windows.h"

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

// Whether no display window lies beyond `data`.
bool holds(const Imath::Box2i &data, const Imath::Box2i &display) {
    return data.intersects(display.min) && data.intersects(display.max);
}

// A few near samples in a huge display window may require a picture of gigabytes.
void check_growth(const OpenedLdi &in, const Ldi &ldi, const Imath::Box2i &window) {
    const double pixels =
        (double(window.max.x) - window.min.x + 1) * (double(window.max.y) - window.min.y + 1);
    const std::size_t channels = ldi.channels.size() * sizeof(float), offset = sizeof(ldi.begin[0]);
    try {
        check_memory(in.name, pixels * double(channels + offset),
                     ldi.samples() * channels + ldi.windows.pixels() * offset);
    } catch (const Error &e) {
        throw Error(fmt::format("{}; --overscan=keep cuts the blur off at the data window", e.what()));
    }
}

// `ldi` with its pixels as far as the blur reaches into the display window, which becomes part of `picture`; empty if
// it reaches nothing beyond `picture`.
std::optional<Ldi> grown(const OpenedLdi &in, const Ldi &ldi, const ThinLens &lens, const LensLooks &looks,
                         Imath::Box2i &picture) {
    const Imath::Box2i before = picture;
    if (lens.radius > 0 && !holds(picture, ldi.windows.display))
        picture.extendBy(reached_display(ldi, lens, looks));
    if (picture == before) return {};
    check_growth(in, ldi, picture);
    return padded(ldi, picture);
}

} // namespace

GatherWindows gather_windows(const WindowOptions &options, const OpenedLdi &in, ThinLens &lens) {
    lens.focal_px /= options.proxy;
    GatherWindows frame{reduced(read_picture_window(in.header), options.proxy), {}, {}};
    if (options.proxy > 1) frame.changed = proxy(in.ldi, options.proxy);
    frame.written = frame.gathered;
    return frame;
}

void choose_windows(GatherWindows &frame, const WindowOptions &options, const OpenedLdi &in,
                    const ThinLens &lens, const LensLooks &looks) {
    if (options.overscan == OutputOverscan::grow)
        if (auto padded = grown(in, frame.ldi(in), lens, looks, frame.gathered))
            frame.changed = std::move(padded);
    frame.written = frame.gathered;
    if (options.overscan == OutputOverscan::crop)
        frame.written =
            common(frame.written, frame.ldi(in).windows.display, "--overscan crop: the display window");
    if (options.region)
        frame.written = common(frame.written, reduced(*options.region, options.proxy), "--region");
}

void raise_highlights(GatherWindows &frame, const OpenedLdi &in, const HighlightGain &by) {
    if (by.gain == 1) return;
    if (!frame.changed) frame.changed = in.ldi;
    raise_highlights(*frame.changed, by);
}

} // namespace sparselens
