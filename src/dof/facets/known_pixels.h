// The known pixels of an LDI: they are transparent to infinity where nothing covers them. In other pixels it is unknown
// what lies behind the samples.
#pragma once

#include "base/image.h"

#include <Imath/ImathBox.h>

#include <span>

namespace sparselens {

struct KnownPixels {
    // The pixels of `window` (EXR coordinates) are known, except those marked in `unseen`, [pixel of the data window].
    // An empty `unseen` marks none.
    Imath::Box2i window;
    std::span<const char> unseen = {};

    KnownPixels(const Imath::Box2i &window_, std::span<const char> unseen_ = {})
        : window(window_), unseen(unseen_) {}
    bool has(const Windows &windows, std::size_t pixel) const {
        return window.intersects(windows.pixel(pixel)) && (unseen.empty() || !unseen[pixel]);
    }
};

} // namespace sparselens
