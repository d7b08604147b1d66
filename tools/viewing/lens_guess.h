// An initial lens if neither the file nor the command line gives one; the page is there to choose another.
#pragma once

#include "viewing/shot_frame.h"
#include "viewing/view_words.h"

namespace sparselens {

// Options of dof-gather for what is unknown: 50 mm before a sensor 36 mm wide, f/2.8, focused on the middle of the
// picture. Empty if all is known.
Words lens_guess(const ShotFrame &frame, const Camera &camera);

// The same in words for people; empty for no options.
std::string guess_in_words(const Words &guess);

} // namespace sparselens
