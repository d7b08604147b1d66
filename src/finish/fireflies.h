// Fireflies: pixels of one render whose light nothing confirms, such as a rare path to a small lamp. They would hide all
// else from the statistics, and one that is believed is seen.
#pragma once

#include "finish/finish.h"

namespace sparselens {

// Replaces both halves by the gathered picture in pixels of fireflies. A pixel of one half is one if it is more than
// FinishTuning::firefly_times as bright as that pixel of the other half and of the gathered picture, and as all but a few
// of the pixels around it: those of the other half up to firefly_radius away, and the gathered picture's 3 x 3. If the
// other half has fewer samples, each weighs more there, so it may be brighter by that factor. A lamp that both halves or
// the gathered picture show is none, and a few fireflies of the other half nearby confirm nothing.
void leave_out_fireflies(LayerToFinish &layer);

} // namespace sparselens
