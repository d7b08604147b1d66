// A view whose pixels are held as packed samples (view_samples.h). The checks and the warp work on it. Most of the
// memory of a warp is its five views, and packed ones take half the memory of pictures.
#pragma once

#include "deep/view_samples.h"
#include "view/place_views.h"

#include <compare>
#include <span>
#include <string>
#include <vector>

namespace sparselens {

struct PackedView {
    std::string name; // for messages
    ViewSamples samples;
    Imath::V2d position{0, 0}; // as in View
    Framing framing = {};

    PackedView(const View &view); // refers to the pixels of the view, which must outlive this
    PackedView(View &&view);      // takes and packs them
    // A deep picture, tidy. If no pixel holds more than one point, it becomes a flat view.
    PackedView(std::string name, Ldi &&samples);
};

std::vector<PackedView> referring_to(std::span<const View> views);
std::vector<PackedView> packed(std::vector<View> &&views); // one at a time

// The view as a picture. The view must not be deep, and must still have the samples that it was made with.
View unpacked(const PackedView &view);

// Like place_views() of view/place_views.h.
Camera place_views(std::span<PackedView> views, std::span<const StatedView> stated);

} // namespace sparselens
