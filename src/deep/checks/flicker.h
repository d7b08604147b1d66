// How much the depth of still surfaces changes from frame to frame, as it does if it is estimated for each by itself.
#pragma once

#include "../../view/view.h"

namespace sparselens {

class Flicker {
public:
    // The median change of disparity (lens/photograph.h) since the last call, over the pixels whose colour hardly
    // changed; 0 for the first frame, for one of another size, and if less than a tenth of the picture stands still.
    double since_last(View frame);

private:
    View last_;
};

} // namespace sparselens
