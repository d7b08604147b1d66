#include "deep/checks/blur_check.h"

#include "base/median.h"
#include "deep/checks/picture_lines.h"
#include "view/flat_pixels.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace sparselens {

namespace {

constexpr std::size_t enough = 100;               // edges
constexpr double defocused = 0.64;                // 0.48 at a CoC of 4, and 1 through a pinhole
constexpr std::size_t side = 3;                   // pixels of a surface on either side of an edge
constexpr std::size_t length = 29;                // pixels from the end of one side to that of the other
constexpr double least_coc = 4, largest_coc = 10; // of the nearer surface: the blur lies between the sides
constexpr double apart = 2;                       // pixels, of CoC
constexpr double contrast = 0.2;                  // of the sides, relative to their sum
constexpr double even = 0.15;                     // change within a side, of the contrast

// The pixels of a view along a line.
struct Along {
    const FlatPixels &picture;
    const std::vector<float> &coc;
    PictureLine line;
    std::size_t from;

    Imath::V3d colour(std::size_t i) const { return picture.colour(line[from + i]); }
    double c(std::size_t i) const { return double(coc[line[from + i]]); }
};

struct Side {
    double coc;
    Imath::V3d colour;
    double uneven; // the largest difference from that colour
};

// The pixels [first, first + side); empty where they show several surfaces.
std::optional<Side> side_of(const Along &pixels, std::size_t first) {
    double least = pixels.c(first), most = least;
    Imath::V3d sum(0, 0, 0);
    for (std::size_t i = first; i < first + side; ++i) {
        least = std::min(least, pixels.c(i));
        most = std::max(most, pixels.c(i));
        sum += pixels.colour(i);
    }
    if (!(most - least < one_surface_px)) return {};
    Side found{(least + most) / 2, sum / double(side), 0};
    for (std::size_t i = first; i < first + side; ++i)
        found.uneven = std::max(found.uneven, (pixels.colour(i) - found.colour).length());
    return found;
}

// The largest share of a step of colour in three pixels; empty where there is no such edge.
std::optional<double> steepest_of(const Along &pixels) {
    const double left_coc = pixels.c(0), right_coc = pixels.c(length - 1); // most lines end here
    const double nearer = std::abs(std::min(left_coc, right_coc));
    if (!(std::abs(left_coc - right_coc) > apart && nearer >= least_coc && nearer <= largest_coc)) return {};
    const auto left = side_of(pixels, 0), right = side_of(pixels, length - side);
    if (!left || !right) return {};
    const Imath::V3d step = right->colour - left->colour;
    if (!(step.length() > contrast * (left->colour + right->colour).length())) return {};
    if (std::max(left->uneven, right->uneven) > even * step.length()) return {};
    double steepest = 0;
    for (std::size_t i = side - 1; i + 3 <= length - side; ++i)
        steepest = std::max(steepest, (pixels.colour(i + 3) - pixels.colour(i)).dot(step) / step.length2());
    return steepest;
}

} // namespace

EdgeSharpness sharpness_of_edges(const View &view, const ThinLens &lens) {
    const FlatPixels pixels = flat_pixels(view);
    if (!pixels.have_colours() || !(lens.radius > 0)) return {};
    std::vector<float> coc(view.z.size());
    for (std::size_t i = 0; i < coc.size(); ++i)
        coc[i] = view.z[i] > 0 ? float(circle_of_confusion(lens, double(view.z[i]))) : 0;
    std::vector<double> found;
    visit_lines(pixels.grid, [&](const PictureLine &line) {
        for (std::size_t i = 0; i + length <= line.length; ++i)
            if (const auto steepest = steepest_of({pixels, coc, line, i})) found.push_back(*steepest);
    });
    if (found.empty()) return {};
    return {found.size(), median(found)};
}

bool looks_defocused(const EdgeSharpness &sharpness) {
    return sharpness.edges >= enough && sharpness.steepest < defocused;
}

} // namespace sparselens
