#include "base/numbers.h"
#include "deep/checks/picture_checks.h"
#include "view/flat_pixels.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace sparselens {

namespace {

constexpr std::size_t enough = 100;    // edges
constexpr double defocused = 0.74;     // half way between 0.48, at a CoC of 4, and 1, through a pinhole
constexpr std::size_t side = 3;        // pixels of a surface on either side of an edge
constexpr std::size_t length = 29;     // pixels from the end of one side to that of the other
constexpr double focused_coc = 1;      // pixels; below, nothing is blurred
constexpr double finer_in_focus = 1.2; // a lens shows 1.8 times as much in focus, and more; a filter as much
constexpr double least_coc = 4, largest_coc = 10; // of the nearer surface: the blur lies between the sides
constexpr double apart = 2;                       // pixels, of CoC
constexpr double contrast = 0.2;                  // of the sides, relative to their sum
constexpr double even = 0.15;                     // change within a side, of the contrast
constexpr std::size_t far_apart = 8;              // pixels: the width of the least blur
constexpr double sharp_step = 2.0 / 23;           // for a step spread over a pixel: 2 / 3 of 8 - 1 / 3

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

// The pixels [first, first + side); empty if they show several surfaces.
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

// The largest change of colour in three pixels, relative to the step; empty if the line crosses no such edge.
std::optional<double> steepest_of(const Along &pixels) {
    const double left_coc = pixels.c(0), right_coc = pixels.c(length - 1); // most lines are rejected here
    const double nearer = std::abs(std::min(left_coc, right_coc));
    if (!(std::abs(left_coc - right_coc) > apart && nearer >= least_coc && nearer <= largest_coc)) return {};
    const auto left = side_of(pixels, 0), right = side_of(pixels, length - side);
    if (!left || !right) return {};
    const Imath::V3d step = right->colour - left->colour;
    if (!(step.length() > contrast * (left->colour + right->colour).length())) return {};
    if (std::max(left->uneven, right->uneven) > even * step.length()) return {};
    double steepest = 0;
    for (std::size_t i = side - 1; i + 3 <= length - side; ++i)
        steepest = std::max(steepest, (pixels.colour(i + 3) - pixels.colour(i)).length());
    return steepest / step.length();
}

// Sums of squared differences of colours, as far as two neighbouring lines agree on them.
struct Variation {
    double near = 0, far = 0;
};

// Adds the lines that begin at `line` and `beside` it, where all that they show counts(pixel).
template <typename Counts>
void add_variation(const FlatPixels &picture, const Counts &counts, const PictureLine &line,
                   std::size_t beside, Variation &sum) {
    const auto shown = [&](std::size_t i) { // so that lights count no more than surfaces
        const Imath::V3d v = picture.colour(i);
        return Imath::V3d(v.x / (1 + v.x), v.y / (1 + v.y), v.z / (1 + v.z));
    };
    const auto product = [&](std::size_t a, std::size_t b) {
        return (shown(line[b]) - shown(line[a])).dot(shown(line[b] + beside) - shown(line[a] + beside));
    };
    std::size_t run = 0; // pixels that count in succession
    for (std::size_t i = 0; i < line.length; ++i) {
        run = counts(line[i]) && counts(line[i] + beside) ? run + 1 : 0;
        if (run <= far_apart) continue;
        sum.near += product(i - 1, i);
        sum.far += product(i - far_apart, i);
    }
}

template <typename Counts>
double fineness_of(const FlatPixels &picture, const Counts &counts) {
    const auto width = std::size_t(picture.grid.width()), height = std::size_t(picture.grid.height());
    Variation sum;
    visit_lines(picture.grid, [&](const PictureLine &line) {
        const std::size_t beside = line.step == 1 ? width : 1;
        if (line[line.length - 1] + beside < width * height)
            add_variation(picture, counts, line, beside, sum);
    });
    return sum.far > 0 ? sum.near / sum.far : 1;
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
    const auto in_focus = [&](std::size_t i) { return std::abs(coc[i]) < float(focused_coc); };
    const auto out_of_focus = [&](std::size_t i) { return std::abs(coc[i]) >= float(least_coc); };
    return {found.size(), median(found), fineness_of(pixels, out_of_focus), fineness_of(pixels, in_focus)};
}

bool looks_defocused(const EdgeSharpness &sharpness) {
    return sharpness.edges >= enough && sharpness.steepest < defocused && sharpness.fine < sharp_step &&
           sharpness.fine_in_focus > finer_in_focus * sharpness.fine;
}

} // namespace sparselens
