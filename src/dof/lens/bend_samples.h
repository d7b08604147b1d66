// Samples as a lens sees them whose plane of focus is not flat, or that magnifies the picture.
#pragma once

#include "dof/lens/sample_blocks.h"
#include "lens/focus_field.h"

namespace sparselens {

// Adds `coc` and what the field says at a sample's place to its CoC, and moves it to where the magnified picture shows it.
// `corner`: of the data window that places are relative to, EXR coordinates.
void bend_samples(BlockedSamples &samples, const FocusField &field, double coc, const PictureFrame &frame,
                  double magnification, const Imath::V2i &corner);

} // namespace sparselens
