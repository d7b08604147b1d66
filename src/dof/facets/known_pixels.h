// The pixels of an LDI that are transparent to infinity where nothing covers them. In others nobody knows what lies behind
// their samples.
#pragma once

#include "base/image.h"

#include <Imath/ImathBox.h>

#include <span>

namespace sparselens {

struct KnownPixels {
    Imath::Box2i window;               // EXR coordinates: those in there,
    std::span<const char> unseen = {}; // [pixel of the data window] but for these; empty: all of them

    KnownPixels(const Imath::Box2i &window_, std::span<const char> unseen_ = {})
        : window(window_), unseen(unseen_) {}
    bool has(const Windows &windows, std::size_t pixel) const {
        return window.intersects(windows.pixel(pixel)) && (unseen.empty() || !unseen[pixel]);
    }
};

} // namespace sparselens
