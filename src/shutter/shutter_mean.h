// The picture of an open shutter: the mean of the pictures of its moments, taken one after the other.
//
// Light, coverage and data are averaged by the weights of the moments, which may differ from row to row. Outside of its
// data window, a moment's picture is empty. The coverage of each id of a Cryptomatte is averaged, and the ids are
// ranked anew. Other ids have no mean: they are those of the middle moment.
#pragma once

#include "base/image.h"
#include "base/matte.h"

#include <cstddef>
#include <span>
#include <vector>

namespace sparselens {

class ShutterMean {
public:
    // Adds the picture of a moment. All have the same display window and the same channels; their data windows may
    // differ. `weights`, each at least 0, are those of the rows of the display window, from the top; rows beyond it
    // have the weight of its first or last row. Results depend on the order of the moments, within rounding.
    void add(const Image &picture, std::span<const double> weights, bool is_middle);

    // The mean; its data window is the smallest that holds those of all moments. In each row, the sum of weights must
    // be above 0.
    Image take();

private:
    void grow(const Imath::Box2i &data);
    void add_row(const Image &picture, int y, double weight, bool is_middle);
    void divide_row(int y);
    std::size_t weighted_row(int y) const; // the row of the display window whose weight counts

    Image sum_;
    std::vector<float> weights_; // of each row; rounded as sums are, so that the mean of ones is one
    std::vector<Matte> mattes_;
    std::vector<std::vector<IdCoverage>> coverages_; // [matte][pixel]
};

} // namespace sparselens
