// Gives small lamps the light that the views show.
//
// A view keeps the light of a lamp exactly: it is the sum over its few pixels. Where views are averaged it is not kept,
// because a pixel on a lamp's edge moves with the depth that the renderer gave it, and some views have more pixels of
// the lamp than others. So the samples of a lamp are scaled: its light becomes the mean over the views that see all of
// it.
#pragma once

#include "warp/images/matched_view.h"

#include <span>

namespace sparselens {

// The LDI is the average of the views, the first of which is the centre. `scale` is R F; perceptive depths that differ
// by less than `surface_px` pixels are one surface. Scales all channels of light except coverage. A lamp stays as it is
// if something nearer cuts it in the centre view, if less than half of the views see all of it and agree within noise,
// or if the change would be large.
void keep_light_of_lamps(std::span<const PlacedView> views, double scale, double surface_px, Ldi &ldi);

} // namespace sparselens
