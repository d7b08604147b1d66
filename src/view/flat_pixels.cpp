#include "view/flat_pixels.h"

#include "base/parallel.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace sparselens {

namespace {

constexpr std::size_t most_around = 5, lone = 7; // of the eight pixels around
constexpr double same_colour = 0.25;             // relative
constexpr float one_depth = 1.02f;     // largest ratio of depths; hair in front of the sky has 1.03 and more
constexpr std::size_t least_lone = 16; // pixels: a picture with fewer has no speckles
constexpr std::size_t one_of = 4;      // lone pixels, at least one is a speckle

double size_of(const Imath::V3d &c) { return std::abs(c.x) + std::abs(c.y) + std::abs(c.z); }

// A pixel's neighbours that are much nearer.
struct Nearer {
    std::array<std::size_t, 8> pixel;
    std::size_t count = 0;

    std::span<const std::size_t> all() const { return std::span(pixel).first(count); }
};

Nearer nearer_around(const FlatPixels &picture, int x, int y) {
    Nearer nearer;
    const float limit = picture.z[picture.grid.index(Position(x, y))] / far_beyond;
    for (int v = std::max(y - 1, 0); v <= std::min(y + 1, picture.grid.height() - 1); ++v)
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, picture.grid.width() - 1); ++u)
            if (const std::size_t i = picture.grid.index(Position(u, v));
                picture.z[i] < limit && picture.opaque(i))
                nearer.pixel[nearer.count++] = i;
    return nearer;
}

bool has_colour_of(const FlatPixels &picture, std::size_t own, const Nearer &nearer) {
    Imath::V3d mean(0);
    for (const std::size_t i : nearer.all()) mean += picture.colour(i);
    mean /= double(nearer.count);
    double spread = 0;
    for (const std::size_t i : nearer.all()) spread += size_of(picture.colour(i) - mean);
    return size_of(picture.colour(own) - mean) <= same_colour * size_of(mean) + spread / double(nearer.count);
}

float middle_depth(const FlatPixels &picture, const Nearer &nearer) {
    std::array<float, 8> depths;
    std::ranges::transform(nearer.all(), depths.begin(), [&](std::size_t i) { return picture.z[i]; });
    const auto middle = depths.begin() + std::ptrdiff_t((nearer.count - 1) / 2);
    std::nth_element(depths.begin(), middle, depths.begin() + std::ptrdiff_t(nearer.count));
    return *middle;
}

// Calls visit(x, y, nearer) for the opaque pixels of a row with at least `least` nearer neighbours.
template <typename Visit>
void for_each_far(const FlatPixels &picture, int y, std::size_t least, const Visit &visit) {
    const std::size_t first = picture.grid.index(Position(0, y));
    const auto width = std::size_t(picture.grid.width());
    const auto nearer_than = [&](std::size_t x, float limit) { return picture.z[first + x] < limit; };
    for (std::size_t x = 0; x < width; ++x) {
        const float limit = picture.z[first + x] / far_beyond;
        // Most pixels have no nearer neighbour here, and five of eight neighbours cannot all be at the corners.
        const bool beside = (x > 0 && nearer_than(x - 1, limit)) ||
                            (x + 1 < width && nearer_than(x + 1, limit)) ||
                            (y > 0 && picture.z[first - width + x] < limit) ||
                            (y + 1 < picture.grid.height() && picture.z[first + width + x] < limit);
        if (!beside || !picture.opaque(first + x)) continue;
        const Nearer nearer = nearer_around(picture, int(x), y);
        if (nearer.count >= least) visit(int(x), y, nearer);
    }
}

bool are_at_one_depth(const FlatPixels &picture, const Nearer &nearer) {
    const auto depth = [&](std::size_t i) { return picture.z[i]; };
    const auto [least, most] = std::ranges::minmax(nearer.all(), {}, depth);
    return depth(most) <= one_depth * depth(least);
}

bool has_speckles(const FlatPixels &picture) {
    std::vector<std::array<std::size_t, 2>> rows(std::size_t(picture.grid.height()),
                                                 {0, 0}); // others, speckles
    parallel_for(rows.size(), [&](std::size_t row) {
        for_each_far(picture, int(row), lone, [&](int x, int y, const Nearer &nearer) {
            ++rows[row][has_colour_of(picture, picture.grid.index(Position(x, y)), nearer) &&
                        are_at_one_depth(picture, nearer)];
        });
    });
    std::size_t speckles = 0, all = 0;
    for (const auto &row : rows) {
        speckles += row[1];
        all += row[0] + row[1];
    }
    return speckles >= least_lone && one_of * speckles >= all;
}

// Replaces all depths of one round at once, so that none is taken from a depth that was replaced before it.
std::size_t repair_once(const FlatPixels &picture, std::span<float> z) {
    const auto depths = joined(std::size_t(picture.grid.height()), [&](std::size_t row) {
        std::vector<std::pair<std::size_t, float>> of_row;
        for_each_far(picture, int(row), most_around, [&](int x, int y, const Nearer &nearer) {
            const std::size_t own = picture.grid.index(Position(x, y));
            if (has_colour_of(picture, own, nearer)) of_row.emplace_back(own, middle_depth(picture, nearer));
        });
        return of_row;
    });
    for (const auto &[i, depth] : depths) z[i] = depth;
    return depths.size();
}

} // namespace

std::size_t repair_speckles(const Windows &windows, std::span<const Channel> channels,
                            std::span<const std::span<const float>> planes, std::span<float> z) {
    const FlatPixels picture = flat_pixels(windows, channels, z, [&](std::size_t k) { return planes[k]; });
    if (!has_speckles(picture)) return 0;
    std::size_t count = 0;
    while (const std::size_t more = repair_once(picture, z)) count += more;
    return count;
}

std::size_t repair_speckles(View &view) {
    std::vector<std::span<const float>> planes;
    for (std::size_t k = 0; k < view.image.channels.size(); ++k) planes.push_back(view.image.plane(k));
    return repair_speckles(view.image.windows, view.image.channels, planes, view.z);
}

std::string speckle_warning(std::size_t repaired) {
    return fmt::format("{} pixels have the depth of the sky amid a surface of their colour, as where rays "
                       "scatter in fog: they take "
                       "the depth of the pixels around them",
                       repaired);
}

} // namespace sparselens
