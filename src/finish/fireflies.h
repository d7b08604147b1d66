// Fireflies: pixels of one render with light that nothing confirms, such as a rare path to a small lamp. They would hide
// all else from the statistics, and stand in the picture.
#pragma once

#include "finish/finish.h"

namespace sparselens {

// Replaces both halves by the gathered picture in the pixels of fireflies. A pixel of one half is a firefly if it is more
// than FinishTuning::firefly_times as bright as
//   - the same pixel of the other half and of the gathered picture, and
//   - all but a few (firefly_rank) of the pixels around it: those of the other half up to firefly_radius away, and the
//     gathered picture's 3 x 3.
// In a half with fewer samples, a pixel may be brighter by the ratio of the samples, because each sample weighs more.
// So lamps stay that both halves or the gathered picture show, and a few fireflies of the other half confirm nothing.
void leave_out_fireflies(LayerToFinish &layer);

} // namespace sparselens
