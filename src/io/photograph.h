// Photographs: PNG, JPEG, TIFF and the like, for the picture, for its estimated depth, or for both.
#pragma once

#include "../view/view.h"
#include "display/shown_picture.h"
#include "exr/exr_deep.h"
#include "open_view.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace sparselens {

// Whether the picture or its depth file is not an EXR file.
bool is_photograph(const std::string &path, const PictureChoice &choice);

// Reads the picture and its depth, integers as 0 to 1. The depth belongs to the picture's display window; beyond it, that
// of an integer file goes on as at its border. A depth of the picture's size stays as it is in the file; one of another
// size is fitted (view/fitted_depth.h). Without a depth file, the depth is that in the photograph itself (own_depth.h).
// Colours of integers are encoded for a display, which the header states (see extras_of); floating-point ones are linear.
// Throws Error or UsageError, naming the file, if it cannot be read, there is no depth, it has another shape, or it has
// colours.
LdiFile read_photograph(const std::string &path, const PictureChoice &choice);

// The parts of a photograph of integers beside its colours, from attributes of its header that EXR files do not get.
// Empty for all other pictures.
std::optional<ShownExtras> extras_of(const Imf::Header &header);
Imf::Header without_extras(const Imf::Header &header);

// Scales disparities of the picture to 0 to 1 unless they lie there, and says so in `warnings`; so it does if they use
// little of that range, or white seems to be far. A `range` that is set scales them in place of their own; one that is
// empty becomes theirs, if it scales them. What is not finite becomes NaN. Throws Error, naming the picture, if all are
// the same.
void repair_disparities(std::span<float> depths, const std::string &name, std::vector<std::string> &warnings,
                        std::optional<DisparityRange> &range);

// What is in focus unless the user says it: the nearest large thing near the middle. Its depth is about the median of the
// nearest third of the middle half, across and down. Empty if there is nothing.
std::optional<PixelInFocus> usual_focus(const Ldi &ldi);

// In place of the unknown one; only tilts and the like depend on it.
Camera photograph_camera();

} // namespace sparselens
