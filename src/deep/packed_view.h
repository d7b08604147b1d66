// A view whose pixels are held as samples (view_samples.h), packed: what the checks and the warp work on. Five views are most
// of what a warp holds, and packed they take half of what they take as pictures.
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
    // A deep picture, tidy. Where no pixel of it holds more than one point, it is a flat view.
    PackedView(std::string name, Ldi &&samples);
};

std::vector<PackedView> referring_to(std::span<const View> views);
std::vector<PackedView> packed(std::vector<View> &&views); // one at a time

// The view as a picture. It is not deep, and has the samples that it was made with.
View unpacked(const PackedView &view);

// As place_views().
Camera place_views(std::span<PackedView> views, std::span<const StatedView> stated);

} // namespace sparselens
