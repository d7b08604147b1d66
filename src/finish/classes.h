// Classes of equal weight along a measure, and the continuous place of a value among them.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace sparselens {

class Classes {
public:
    // For values in [least, most]; values outside count as the nearer end.
    Classes(std::size_t count, float least, float most);

    // Each pixel counts half by its weight and half by itself, so that neither many pixels of little weight nor a few of
    // much make all classes.
    void add(float value, double weight);
    void divide(); // after the last add()

    std::size_t of(float value) const; // [0, count)
    float place_of(float value) const; // the same, continuous: k + 1/2 in the middle of class k

private:
    float bin_of(float value) const; // continuous

    std::size_t count_;
    float least_, most_;
    std::vector<std::array<double, 2>> bins_; // pixels, weights
    std::vector<float> places_;               // where bins begin, in classes; one more
};

} // namespace sparselens
