#include "deep/checks/picture_checks.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

double largest_circle_of_confusion(std::span<const float> depths, const ThinLens &lens) {
    double largest = 0;
    for (const float z : depths)
        if (z > 0) largest = std::max(largest, std::abs(circle_of_confusion(lens, double(z))));
    return largest;
}

bool blurs_nothing(double largest_coc, const ThinLens &lens) {
    return lens.radius > 0 && largest_coc > 0 && largest_coc < 0.5;
}

std::vector<std::size_t> views_beyond_lens(std::span<const PackedView> views, double lens_radius) {
    constexpr double too_far = 3; // radii
    std::vector<std::size_t> beyond;
    for (std::size_t i = 0; i < views.size(); ++i)
        if (lens_radius > 0 && views[i].position.length() > too_far * lens_radius) beyond.push_back(i);
    return beyond;
}

} // namespace sparselens
