// The picture of an open shutter: the mean of the pictures of its moments, taken one after the other.
//
// Light, coverage and data are averaged by the weights of the moments. Outside of its data window, a moment's picture
// is empty. The coverage of each id of a Cryptomatte is averaged, and the ids are ranked anew. Other ids have no mean:
// they are those of the middle moment.
#pragma once

#include "base/image.h"
#include "base/matte.h"

#include <vector>

namespace sparselens {

class ShutterMean {
public:
    // Adds the picture of a moment. All have the same display window and the same channels; their data windows may
    // differ. The weight is at least 0. Results depend on the order of the moments, within rounding.
    void add(const Image &picture, double weight, bool is_middle);

    // The mean; its data window is the smallest that holds those of all moments. The sum of weights must be above 0.
    Image take();

private:
    void grow(const Imath::Box2i &data);
    void add_row(const Image &picture, int y, double weight, bool is_middle);

    Image sum_;
    float weights_ = 0; // rounded as sums are, so that the mean of ones is one
    std::vector<Matte> mattes_;
    std::vector<std::vector<IdCoverage>> coverages_; // [matte][pixel]
};

} // namespace sparselens
