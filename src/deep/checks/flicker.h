// How much the depth of still surfaces changes from one frame of a photographed sequence to the next, as it does if each
// frame's depth is estimated by itself.
#pragma once

#include "../../view/view.h"

namespace sparselens {

class Flicker {
public:
    // The median change of disparity (lens/photograph.h) since the last call, over the pixels whose colour hardly changed;
    // 0 for the first frame, for one of another size, and if less than a tenth of the picture stands still.
    double since_last(View frame);

private:
    View last_;
};

} // namespace sparselens
