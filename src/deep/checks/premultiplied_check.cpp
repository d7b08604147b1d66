#include "base/median.h"
#include "deep/checks/picture_checks.h"
#include "deep/checks/picture_lines.h"

#include <cmath>
#include <vector>

namespace sparselens {

namespace {

constexpr std::size_t enough = 50; // pixels
constexpr double between = 0.5;    // between colours that fall and colours that stay
constexpr double mostly_open =
    0.35; // coverage below which a premultiplied colour is dark, even of a rim twice as bright
constexpr double nothing = 1e-3;  // coverage, and light relative to the surface's
constexpr double even = 0.15;     // change of the surface's light beside the edge
constexpr std::size_t widest = 3; // pixels of an edge

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
    if (!(surface > 0) || !(std::abs(walk.light(0) - surface) < even * surface)) return;
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

bool looks_unpremultiplied(const EdgeFall &fall) { return fall.pixels >= enough && fall.stays > between; }

} // namespace sparselens
