#include "deep/checks/picture_checks.h"

#include "base/numbers.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sparselens {

namespace {

constexpr double explained = 0.1;        // of the pixels
constexpr double sure = 3;               // standard deviations
constexpr double around = 0.5;           // of the way from the line to the curve
constexpr double contrast = 0.15;        // of the sides, relative to their sum
constexpr double even = 0.1;             // change within a side, of the contrast
constexpr double clearly_mixed = 0.15;   // share of either side, at least
constexpr double least_departure = 0.01; // of the curve from the line, relative to the contrast

Imath::V3d decoded(const Imath::V3d &v) { return {srgb_decoded(v.x), srgb_decoded(v.y), srgb_decoded(v.z)}; }
Imath::V3d encoded(const Imath::V3d &v) { return {srgb_encoded(v.x), srgb_encoded(v.y), srgb_encoded(v.z)}; }

// The point at `along` on the way from a to b for a mixture of light that is encoded afterwards.
Imath::V3d on_curve(const Imath::V3d &a, const Imath::V3d &b, double along) {
    const Imath::V3d light_a = decoded(a), light_b = decoded(b), way = b - a;
    double low = 0, high = 1;
    Imath::V3d at = a;
    for (int i = 0; i < 12; ++i) { // far finer than the check needs
        const double share = (low + high) / 2;
        at = encoded(light_a * (1 - share) + light_b * share);
        ((at - a).dot(way) < along * way.length2() ? low : high) = share;
    }
    return at;
}

// Counts a pixel between two sides.
void ask(const Imath::V3d &a, const Imath::V3d &pixel, const Imath::V3d &b, EdgeMixing &mixing) {
    const Imath::V3d way = b - a;
    const double along = (pixel - a).dot(way) / way.length2();
    if (along < clearly_mixed || along > 1 - clearly_mixed) return;
    const Imath::V3d on_line = a + way * along;
    const Imath::V3d departure = on_curve(a, b, along) - on_line;
    if (departure.length() < least_departure * way.length()) return;
    const auto is_at = [&](double place) {
        return (pixel - on_line - departure * place).length() < around * departure.length();
    };
    ++mixing.pixels;
    mixing.light += is_at(0);
    mixing.encoded += is_at(1);
    mixing.beyond += is_at(2);
}

// Whether the count `a` exceeds `b` by more than chance.
bool surely_more(std::size_t a, std::size_t b) {
    return double(a) - double(b) > sure * std::sqrt(double(a + b));
}

bool is_displayable(const Imath::V3d &v) {
    return std::min({v.x, v.y, v.z}) >= 0 && std::max({v.x, v.y, v.z}) <= 1;
}

} // namespace

EdgeMixing mixing_at_edges(const View &view) {
    const FlatPixels pixels = flat_pixels(view);
    if (!pixels.have_colours()) return {};
    const auto colour = [&](std::size_t i) { return pixels.colour(i); };
    EdgeMixing mixing;
    visit_lines(pixels.grid, [&](const PictureLine &line) {
        for (std::size_t i = 2; i + 2 < line.length; ++i) {
            const Imath::V3d a = colour(line[i - 1]), b = colour(line[i + 1]);
            const double apart = (b - a).length();
            if (!(apart > contrast * (a + b).length())) continue;
            if (!is_displayable(a) || !is_displayable(b)) continue;
            if ((colour(line[i - 2]) - a).length() > even * apart) continue;
            if ((colour(line[i + 2]) - b).length() > even * apart) continue;
            ask(a, colour(line[i]), b, mixing);
        }
    });
    return mixing;
}

bool looks_encoded(const EdgeMixing &mixing) {
    return double(mixing.encoded) >= explained * double(mixing.pixels) &&
           surely_more(mixing.encoded, mixing.light) && surely_more(mixing.encoded, mixing.beyond);
}

namespace {

constexpr std::size_t enough_pixels = 50;
constexpr double between = 0.5; // between colours that fall and colours that stay
constexpr double mostly_open =
    0.35; // coverage below which a premultiplied colour is dark, even of a rim twice as bright
constexpr double nothing = 1e-3;     // coverage, and light relative to the surface's
constexpr double even_surface = 0.5; // change of the surface's light beside the edge, by its texture
constexpr std::size_t widest = 12;   // pixels of an edge

// A row or column, from one pixel on and in one direction.
struct Walk {
    const FlatPixels &picture;
    const PictureLine &line;
    std::size_t from;
    int step;

    bool reaches(std::size_t i) const {
        const auto at = std::ptrdiff_t(from) + step * std::ptrdiff_t(i);
        return at >= 0 && at < std::ptrdiff_t(line.length);
    }
    std::size_t pixel(std::size_t i) const {
        return line[std::size_t(std::ptrdiff_t(from) + step * std::ptrdiff_t(i))];
    }
    double coverage(std::size_t i) const { return double(picture.coverage(pixel(i))); }
    double light(std::size_t i) const {
        const Imath::V3d c = picture.colour(pixel(i));
        return std::abs(c.x) + std::abs(c.y) + std::abs(c.z);
    }
};

// Measures an edge: pixels 0 and 1 show the surface; then the edge follows, and then nothing.
void look_at(const Walk &walk, std::vector<double> &found) {
    if (!walk.reaches(3) || walk.coverage(0) < 1 - nothing || walk.coverage(1) < 1 - nothing) return;
    const double surface = walk.light(1);
    if (!(surface > 0) || !(std::abs(walk.light(0) - surface) < even_surface * surface)) return;
    std::size_t end = 2;
    while (walk.reaches(end) && walk.coverage(end) > nothing && walk.coverage(end) < walk.coverage(end - 1))
        ++end;
    if (end == 2 || end > 2 + widest || !walk.reaches(end) || walk.coverage(end) > nothing) return;
    if (walk.light(end) > nothing * surface) return; // there is light without coverage
    for (std::size_t i = 2; i < end; ++i)
        if (const double a = walk.coverage(i); a < mostly_open)
            found.push_back((walk.light(i) / surface - a) / (1 - a));
}

} // namespace

EdgeFall fall_at_edges(const FlatPixels &pixels) {
    if (pixels.alpha.empty() || !pixels.have_colours()) return {};
    std::vector<double> found;
    visit_lines(pixels.grid, [&](const PictureLine &line) {
        for (std::size_t i = 0; i < line.length; ++i)
            for (const int step : {1, -1}) look_at({pixels, line, i, step}, found);
    });
    if (found.empty()) return {};
    return {found.size(), median(found)};
}

bool looks_unpremultiplied(const EdgeFall &fall) {
    return fall.pixels >= enough_pixels && fall.stays > between;
}

namespace {

constexpr double most_edges = 0.8; // of the pixels at soft edges

// Adds, for the pixels at the edge that begins at `walk`, the depth b behind, relative to the surface's.
void add_depths_behind(const Walk &walk, std::span<const float> z, std::vector<double> &behind) {
    const double surface = double(z[walk.pixel(0)]);
    if (walk.coverage(0) < 1 - nothing || !std::isfinite(surface)) return;
    for (std::size_t i = 1; walk.reaches(i); ++i) {
        const double a = walk.coverage(i), here = double(z[walk.pixel(i)]);
        if (!(a > nothing && a < walk.coverage(i - 1)) || !std::isfinite(here)) return;
        if (a >= 0.1 && a <= 0.9) behind.push_back((here / surface - a) / (1 - a));
    }
}

} // namespace

EdgeDepths depths_at_edges(const View &view) {
    const FlatPixels pixels = flat_pixels(view);
    if (pixels.alpha.empty()) return {};
    std::vector<double> behind;
    visit_lines(pixels.grid, [&](const PictureLine &line) {
        for (std::size_t i = 0; i < line.length; ++i)
            for (const int step : {1, -1}) add_depths_behind({pixels, line, i, step}, view.z, behind);
    });
    if (behind.empty()) return {};
    const auto count = [&](const auto &is) { return std::size_t(std::ranges::count_if(behind, is)); };
    EdgeDepths found{behind.size(), count([](double b) { return std::abs(b) < 0.1; }), 0};
    if (const double usual = median(behind); usual > 1.5)
        found.averaged = count([=](double b) { return std::abs(b / usual - 1) < 0.05; });
    return found;
}

bool looks_multiplied(const EdgeDepths &depths) {
    return depths.pixels >= enough_pixels && double(depths.multiplied) >= most_edges * double(depths.pixels);
}

bool looks_averaged(const EdgeDepths &depths) {
    return depths.pixels >= enough_pixels && double(depths.averaged) >= most_edges * double(depths.pixels);
}

bool lacks_coverage(const View &view) {
    const FlatPixels pixels = flat_pixels(view);
    if (pixels.alpha.empty() || std::ranges::any_of(pixels.alpha, [](float a) { return a != 0; }))
        return false;
    for (std::size_t i = 0; i < view.z.size(); ++i)
        if (pixels.colour(i) != Imath::V3d(0, 0, 0)) return true;
    return false;
}

namespace {

constexpr std::size_t enough_slopes = 200;
constexpr double mostly = 0.5;           // of the slopes
constexpr double hardly = 0.1;           // of the slopes
constexpr double clearly = 0.01;         // bend, relative to the change over the slope
constexpr double smooth_bend = 0.4;      // the smallest of four steps, relative to their mean
constexpr std::size_t shortest = 2;      // pixels, of a step
constexpr std::size_t steps_across = 96; // of a picture

// How far the middle of a slope lies above the mean of its ends, relative to their difference; 0 if it is not a slope.
double bend_of(const std::array<double, 5> &v) {
    const double step = (v[4] - v[0]) / 4;
    if (!(std::min(v[0], v[4]) > 0) || step == 0) return 0;
    for (std::size_t i = 0; i < 4; ++i) {
        const double own = (v[i + 1] - v[i]) / step;
        if (!(own > smooth_bend && own < 1 / smooth_bend)) return 0;
    }
    return ((v[0] + v[4]) / 2 - v[2]) / std::abs(v[4] - v[0]);
}

} // namespace

DepthBends bends_of_depth(const ArrayGrid &grid, std::span<const float> depths) {
    const auto across = std::size_t(std::max(grid.width(), grid.height()));
    const std::size_t step = std::max(shortest, across / steps_across);
    std::size_t all = 0, upward = 0, downward = 0;
    visit_lines(grid, [&](const PictureLine &line) {
        for (std::size_t i = 0; i + 4 * step < line.length; ++i) {
            std::array<double, 5> v{};
            for (std::size_t k = 0; k < v.size(); ++k) v[k] = double(depths[line[i + k * step]]);
            const double bend = bend_of(v);
            if (bend == 0) continue;
            ++all;
            upward += bend > clearly;
            downward += bend < -clearly;
        }
    });
    if (all == 0) return {};
    return {all, double(upward) / double(all), double(downward) / double(all)};
}

bool looks_white_near(const ArrayGrid &grid, std::span<const float> depths) {
    if (!std::ranges::all_of(depths, [](float v) { return v >= 0 && v <= 1; })) return false;
    const DepthBends bends = bends_of_depth(grid, depths);
    return bends.slopes >= enough_slopes && bends.downward > mostly && bends.upward < hardly;
}

namespace {

constexpr std::size_t half_length = 4; // pixels, of a slope
constexpr double least_ratio = 1.04;   // of a slope's end depths; lower ones rather show bent surfaces
constexpr double largest_ratio = 1.5;  // a larger ratio is an edge
constexpr double alike = 0.3;          // largest distance from a mean, where one mean is 0 and the other 1
constexpr double smooth_depth = 0.6;   // the smallest of four steps, relative to their mean

// Where the middle of a slope lies, if one was found: 0 at the plain mean of its ends, 1 at the harmonic mean.
struct Slope {
    bool found = false;
    double place = 0;
};

template <typename Depth> // depth(i) takes i from 0 to 2 * half_length
Slope slope_of(const Depth &depth) {
    const double a = depth(0), middle = depth(half_length), b = depth(2 * half_length);
    const double ratio = std::max(a, b) / std::min(a, b);
    if (!(ratio > least_ratio && ratio < largest_ratio)) return {}; // rejects sky and empty pixels too
    const double step = (b - a) / 4;
    for (std::size_t i = 0; i < 4; ++i) {
        const double own = depth((i + 1) * half_length / 2) - depth(i * half_length / 2);
        if (!(own / step > smooth_depth && own / step < 1 / smooth_depth)) return {};
    }
    const double mean = (a + b) / 2, harmonic = 2 * a * b / (a + b);
    return {true, (middle - mean) / (harmonic - mean)};
}

} // namespace

DepthSlopes slopes_of_depth(const View &view) {
    std::size_t all = 0, planar = 0, inverse = 0;
    visit_lines(view.image.windows.grid().array(), [&](const PictureLine &line) {
        for (std::size_t i = 0; i + 2 * half_length < line.length; ++i) {
            const Slope slope = slope_of([&](std::size_t k) { return double(view.z[line[i + k]]); });
            if (!slope.found) continue;
            ++all;
            planar += std::abs(slope.place - 1) < alike;
            inverse += std::abs(slope.place) < alike;
        }
    });
    if (all == 0) return {};
    return {all, double(planar) / double(all), double(inverse) / double(all)};
}

bool looks_inverse(const DepthSlopes &slopes) {
    return slopes.slopes >= enough_slopes && slopes.inverse > mostly;
}

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
