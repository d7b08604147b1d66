#include "plan/disocclusion.h"

#include "base/parallel.h"
#include "plan/tuning.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

namespace sparselens {

namespace {

// Moves the centre view's pixels to their places in the rim view.
class Mover {
public:
    Mover(const Windows &windows, std::span<const float> z, const ThinLens &lens, const Imath::V2d &u)
        : data_(windows.data), grid_(windows.width(), windows.height()),
          shift_(-u.x, u.y * lens.pixel_aspect), depth_(z.size()) {
        std::transform(z.begin(), z.end(), depth_.begin(),
                       [&](float value) { return disparity(lens, value); });
    }

    MovedDepth run() const {
        MovedDepth moved{PixelMask(data_), PixelMask(data_),
                         std::vector<float>(depth_.size(), MovedDepth::nothing)};
        for (int row = 0; row < grid_.height(); ++row)
            for (int column = 0; column < grid_.width(); ++column)
                if (std::isfinite(depth(column, row))) move(column, row, moved);
        for (int row = 0; row < grid_.height(); ++row)
            open_edge(Position(shift_.x < 0 ? grid_.width() - 1 : 0, row), {shift_.x < 0 ? -1 : 1, 0},
                      std::abs(shift_.x) * nearest_along(shift_.x < 0 ? grid_.width() - 1 : 0, row, 0, 1),
                      moved);
        for (int column = 0; column < grid_.width(); ++column)
            open_edge(Position(column, shift_.y < 0 ? grid_.height() - 1 : 0), {0, shift_.y < 0 ? -1 : 1},
                      std::abs(shift_.y) * nearest_along(column, shift_.y < 0 ? grid_.height() - 1 : 0, 1, 0),
                      moved);
        return moved;
    }

private:
    // The largest disparity along the border near here: something as near may stand beyond the border and come
    // into view.
    double nearest_along(int column, int row, int dx, int dy) const {
        double nearest = 0;
        for (int i = -PlanTuning::edge_hereabouts; i <= PlanTuning::edge_hereabouts; ++i)
            if (in_frame(column + i * dx, row + i * dy) &&
                std::isfinite(depth(column + i * dx, row + i * dy)))
                nearest = std::max(nearest, depth(column + i * dx, row + i * dy));
        return nearest;
    }

    void open_edge(Position at, const Imath::V2i &inwards, double pixels, MovedDepth &moved) const {
        for (int i = 0; i < int(std::min(std::ceil(pixels), 1e9)) && grid_.contains(at);
             ++i, at = at + inwards)
            moved.edge.set[grid_.index(at)] = 1;
    }

    double depth(int column, int row) const { return depth_[grid_.index(Position(column, row))]; }
    bool in_frame(int column, int row) const { return grid_.contains(Position(column, row)); }

    // How much deeper the neighbour (dx, dy) is, if both are one surface.
    std::optional<double> step(int column, int row, int dx, int dy) const {
        if (!in_frame(column + dx, row + dy)) return {};
        const double difference = depth(column + dx, row + dy) - depth(column, row);
        return std::abs(difference) <= torn_px ? std::optional(difference) : std::nullopt;
    }

    // How far the pixel reaches towards its neighbour (dx, dy), along that axis, from its own moved centre: halfway to
    // the neighbour's if they are one surface, plus the distance by which a surface that slants across moves its
    // neighbours there. Unlimited towards the border of the picture.
    double reach(int column, int row, int dx, int dy) const {
        if (!in_frame(column + dx, row + dy)) return grid_.width() + grid_.height();
        const double shift = dx != 0 ? dx * shift_.x : dy * shift_.y;
        const double across = std::max({0.0, step(column, row, dy, dx).value_or(0) * shift,
                                        step(column, row, -dy, -dx).value_or(0) * shift});
        return 0.5 * (1 + step(column, row, dx, dy).value_or(0) * shift + across);
    }

    void move(int column, int row, MovedDepth &moved) const {
        const double d = depth(column, row), x = column + 0.5 + d * shift_.x, y = row + 0.5 + d * shift_.y;
        const auto first = [](double edge) { return std::ceil(edge - 0.5); }; // pixel centres at or beyond it
        const Imath::Box2d box({first(x - reach(column, row, -1, 0)), first(y - reach(column, row, 0, -1))},
                               {first(x + reach(column, row, 1, 0)), first(y + reach(column, row, 0, 1))});
        const Imath::Box2d own({first(x - 1), first(y - 1)}, {first(x + 1), first(y + 1)});
        const auto within = [](double edge, int size) { return int(std::clamp(edge, 0.0, double(size))); };
        const int x0 = within(box.min.x, grid_.width()), x1 = within(box.max.x, grid_.width());
        const int y0 = within(box.min.y, grid_.height()), y1 = within(box.max.y, grid_.height());
        for (int to_y = y0; to_y < y1; ++to_y)
            for (int to_x = x0; to_x < x1; ++to_x) {
                const std::size_t to = grid_.index(Position(to_x, to_y));
                moved.depth[to] = std::max(moved.depth[to], float(d));
                const bool near =
                    to_x >= own.min.x && to_x < own.max.x && to_y >= own.min.y && to_y < own.max.y;
                if (near) moved.inside.set[to] = 1;
            }
    }

    Imath::Box2i data_;
    ArrayGrid grid_;            // the window, from its corner
    Imath::V2d shift_;          // for disparity 1, pixels, y down
    std::vector<double> depth_; // disparities
};

// Sets all values within `margin` of a set value in a line of `count` values, `stride` apart.
void grow_line(const std::uint8_t *from, std::uint8_t *to, int count, std::size_t stride, int margin) {
    const auto grow = [&](int i, int &last) { // last: the previous set value
        if (from[std::size_t(i) * stride]) last = i;
        if (std::abs(i - last) <= margin) to[std::size_t(i) * stride] = 1;
    };
    int last = -margin - 1;
    for (int i = 0; i < count; ++i) grow(i, last);
    last = count + margin;
    for (int i = count - 1; i >= 0; --i) grow(i, last);
}

} // namespace

std::size_t PixelMask::count() const { return std::accumulate(set.begin(), set.end(), std::size_t{0}); }

MovedDepth move_depth(const Windows &windows, std::span<const float> z, const ThinLens &lens,
                      const Imath::V2d &u) {
    return Mover(windows, z, lens, u).run();
}

PixelMask disoccluded(const MovedDepth &moved) {
    PixelMask mask(moved.inside.data);
    std::ranges::transform(moved.depth, mask.set.begin(), [](float d) { return d == MovedDepth::nothing; });
    return mask;
}

PixelMask unseen_by_centre(const MovedDepth &moved) {
    PixelMask mask(moved.inside.data);
    std::ranges::transform(moved.inside.set, mask.set.begin(), [](std::uint8_t seen) { return !seen; });
    return mask;
}

PixelMask pixels_that_show(const MovedDepth &moved, const PixelMask &of_centre, const ThinLens &lens,
                           const Imath::V2d &u) {
    PixelMask mask(of_centre.data);
    const ArrayGrid grid = mask.grid().array();
    for (std::size_t i = 0; i < mask.set.size(); ++i) {
        const double depth = moved.depth[i];
        if (depth == MovedDepth::nothing) continue;
        const Position at = grid.position(i),
                       from(int(std::lround(at.column + depth * u.x)),
                            int(std::lround(at.row - depth * u.y * lens.pixel_aspect)));
        mask.set[i] = grid.contains(from) && of_centre.set[grid.index(from)];
    }
    return mask;
}

PixelMask without_slits(const PixelMask &mask) {
    PixelMask wide = mask;
    const ArrayGrid grid = mask.grid().array();
    const auto slit = [&](std::size_t i, std::size_t step) {
        return !mask.set[i - step] && !mask.set[i + step];
    };
    for (int y = 0; y < grid.height(); ++y)
        for (int x = 0; x < grid.width(); ++x) {
            const std::size_t i = grid.index(Position(x, y));
            const bool across = x > 0 && x < grid.width() - 1 && slit(i, 1);
            const bool down = y > 0 && y < grid.height() - 1 && slit(i, std::size_t(grid.width()));
            if (across || down) wide.set[i] = 0;
        }
    return wide;
}

PixelMask grown(const PixelMask &mask, int margin) {
    PixelMask rows(mask.data), both(mask.data);
    const ArrayGrid grid = mask.grid().array();
    for (int y = 0; y < grid.height(); ++y)
        grow_line(&mask.set[grid.index(Position(0, y))], &rows.set[grid.index(Position(0, y))], grid.width(),
                  1, margin);
    for (int x = 0; x < grid.width(); ++x)
        grow_line(&rows.set[grid.index(Position(x, 0))], &both.set[grid.index(Position(x, 0))], grid.height(),
                  std::size_t(grid.width()), margin);
    return both;
}

double share_at_edges(const Windows &windows, std::span<const float> z, const ThinLens &lens) {
    const ArrayGrid grid = windows.grid().array();
    const auto depth = [&](int x, int y) { return disparity(lens, double(z[grid.index(Position(x, y))])); };
    std::vector<std::size_t> edges(std::size_t(grid.height())); // by row
    parallel_for(edges.size(), [&](std::size_t row) {
        const int y = int(row);
        for (int x = 0; x < grid.width(); ++x) {
            const double own = depth(x, y);
            const auto torn = [&](int u, int v) {
                return grid.contains(Position(u, v)) && std::abs(depth(u, v) - own) > double(torn_px);
            };
            edges[row] += torn(x - 1, y) || torn(x + 1, y) || torn(x, y - 1) || torn(x, y + 1);
        }
    });
    return double(std::accumulate(edges.begin(), edges.end(), std::size_t{0})) / double(grid.size());
}

namespace {

double area(const Imath::Box2i &box) {
    return box.isEmpty() ? 0 : double(box.max.x - box.min.x + 1) * double(box.max.y - box.min.y + 1);
}

Imath::Box2i together(Imath::Box2i a, const Imath::Box2i &b) {
    a.extendBy(b);
    return a;
}

// The number of pixels that one rectangle for both boxes asks for in vain.
double waste(const Imath::Box2i &a, const Imath::Box2i &b) {
    return area(together(a, b)) - area(a) - area(b);
}

// The set pixels of a band of rows as tight boxes. A new box begins where columns stay empty for a while.
std::vector<Imath::Box2i> boxes_of_band(const PixelMask &mask, int first_row, int last_row) {
    std::vector<Imath::Box2i> boxes;
    for (int x = mask.data.min.x; x <= mask.data.max.x; ++x)
        for (int y = first_row; y <= last_row; ++y) {
            if (!mask.at(Imath::V2i(x, y))) continue;
            if (boxes.empty() || x - boxes.back().max.x > PlanTuning::rectangle_gap) boxes.emplace_back();
            boxes.back().extendBy(Imath::V2i(x, y));
        }
    return boxes;
}

// Joins each box of a band with the box above with which it wastes least, if that pays.
void join_band(const std::vector<Imath::Box2i> &band, int first_row, std::vector<Imath::Box2i> &boxes) {
    const std::size_t above = boxes.size();
    for (const Imath::Box2i &box : band) {
        Imath::Box2i *best = nullptr;
        double least = PlanTuning::rectangle_overhead;
        for (std::size_t i = 0; i < above; ++i) {
            if (boxes[i].max.y < first_row - PlanTuning::rectangle_gap || waste(boxes[i], box) >= least)
                continue;
            least = waste(boxes[i], box);
            best = &boxes[i];
        }
        if (best)
            best->extendBy(box);
        else
            boxes.push_back(box);
    }
}

// Joins the two boxes that waste least. Returns whether any were joined.
bool join_cheapest(std::vector<Imath::Box2i> &boxes, double limit) {
    std::size_t first = 0, second = 0;
    double least = limit;
    for (std::size_t i = 0; i < boxes.size(); ++i)
        for (std::size_t k = i + 1; k < boxes.size(); ++k)
            if (waste(boxes[i], boxes[k]) < least) {
                least = waste(boxes[i], boxes[k]);
                first = i;
                second = k;
            }
    if (first == second) return false;
    boxes[first].extendBy(boxes[second]);
    boxes.erase(boxes.begin() + std::ptrdiff_t(second));
    return true;
}

} // namespace

std::vector<Imath::Box2i> rectangles_over(const PixelMask &mask, std::size_t most) {
    const int band_rows = std::max(8, mask.height() / 64);
    std::vector<Imath::Box2i> boxes;
    for (int row = mask.data.min.y; row <= mask.data.max.y; row += band_rows)
        join_band(boxes_of_band(mask, row, std::min(row + band_rows - 1, mask.data.max.y)), row, boxes);
    while (boxes.size() > most && join_cheapest(boxes, std::numeric_limits<double>::infinity())) {
    }
    while (join_cheapest(boxes, PlanTuning::rectangle_overhead)) {
    }
    return boxes;
}

} // namespace sparselens
