// Classes of equal weight along a measure, and the continuous place of a value in them.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace sparselens {

class Classes {
public:
    // For values in [least, most]; other values count as the nearer limit.
    Classes(std::size_t count, float least, float most);

    // Each pixel counts half by its weight and half equally, so that neither many pixels of little weight nor a few of
    // great weight make up all classes.
    void add(float value, double weight);
    void divide(); // after the last add()

    std::size_t of(float value) const; // [0, count)
    float place_of(float value) const; // the same, continuous: k + 1/2 in the middle of class k

private:
    float bin_of(float value) const; // continuous

    std::size_t count_;
    float least_, most_;
    std::vector<std::array<double, 2>> bins_; // pixels, weights
    std::vector<float> places_;               // of the beginnings of bins, and of the last end
};

} // namespace sparselens
