#include "support/order.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace sparselens {

namespace {

using Extent = std::pair<float, float>; // z, z_back: ordered as samples are

bool has_nan(const std::vector<Extent> &extents) {
    return std::ranges::any_of(extents,
                               [](const Extent &e) { return std::isnan(e.first) || std::isnan(e.second); });
}

bool is_sorted_strictly(const std::vector<Extent> &extents) {
    for (std::size_t i = 1; i < extents.size(); ++i)
        if (!(extents[i - 1] < extents[i])) return false;
    return true;
}

// In sorted extents, neighbours overlap first, so only they are compared.
bool are_apart(const std::vector<Extent> &extents) {
    for (std::size_t i = 1; i < extents.size(); ++i) {
        const auto &[z, back] = extents[i - 1];
        const auto &[next_z, next_back] = extents[i];
        const bool before = z < next_z && back <= next_z;
        const bool point_at_the_front_of_a_volume = z == next_z && back <= z && next_back > next_z;
        if (!before && !point_at_the_front_of_a_volume) return false;
    }
    return true;
}

} // namespace

Order order_of(const Ldi &ldi) {
    Order order;
    for (std::size_t pixel = 0; pixel < ldi.windows.pixels(); ++pixel) {
        std::vector<Extent> extents;
        for (const std::uint64_t i : ldi.pixel(pixel))
            extents.emplace_back(ldi.z[i], ldi.z_back.empty() ? ldi.z[i] : ldi.z_back[i]);
        order.sorted = order.sorted && is_sorted_strictly(extents);
        if (!has_nan(extents)) std::ranges::sort(extents);
        order.apart = order.apart && !has_nan(extents) && are_apart(extents);
    }
    return order;
}

} // namespace sparselens
