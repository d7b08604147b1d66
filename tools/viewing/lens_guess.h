// A lens to begin with, where neither the file nor the command line says one: choosing it is what the page is for.
#pragma once

#include "viewing/shot_frame.h"
#include "viewing/view_words.h"

namespace sparselens {

// Options of dof-gather for what is unknown: 50 mm before a sensor 36 mm wide, f/2.8, focused on what the middle of the
// picture shows. Empty where all is known.
Words lens_guess(const ShotFrame &frame, const Camera &camera);

// The same for people; empty for no words.
std::string guess_in_words(const Words &guess);

} // namespace sparselens
