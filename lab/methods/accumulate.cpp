#include "lab/methods/accumulate.h"

#include "base/error.h"
#include "base/parallel.h"
#include "lab/methods/parabolic_shift.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace sparselens {

namespace {

bool is_depth(const std::string &name) {
    for (const std::string depth : {"Z", "depth.Z", ".Depth.Z"})
        for (const std::string &end : {depth, depth + "Back"})
            if (name == end || (depth.front() == '.' && name.ends_with(end))) return true;
    return false;
}

// One axis of a move: target pixel x covers [x + whole + part, x + whole + part + 1) of the view; targets
// [begin, end) have their centre inside the view.
struct AxisMove {
    int whole = 0, begin = 0, end = 0;
    float part = 0;
};

AxisMove axis_move(double shift, int view_min, int view_max, int target_min, int target_max) {
    const double begin = std::ceil(view_min + shift - 0.5), end = std::ceil(view_max + 0.5 + shift);
    AxisMove move;
    if (!(begin <= target_max && end > target_min)) return move; // also keeps huge shifts out of the integers
    const double whole = std::floor(-shift);
    move.whole = int(whole);
    move.part = float(-shift - whole);
    move.begin = int(std::max(begin, double(target_min)));
    move.end = int(std::min(end, target_max + 1.0));
    return move;
}

// One channel of a view; outside, the outermost pixels continue.
struct Plane {
    const float *values;
    const Imath::Box2i &window;

    std::size_t width() const { return std::size_t(window.max.x) - std::size_t(window.min.x) + 1; }
    const float *row(int y) const {
        const int inside = std::clamp(y, window.min.y, window.max.y);
        return values + std::size_t(inside - window.min.y) * width();
    }
};

using Line = std::vector<float>;

// Integrates the parabolas over the upper `part` of each pixel of row y.
void integrate_row(const Plane &plane, int y, float part, Line &integrals) {
    const std::array rows{plane.row(y - 2), plane.row(y - 1), plane.row(y), plane.row(y + 1),
                          plane.row(y + 2)};
    for (std::size_t x = 0; x < integrals.size(); ++x)
        integrals[x] = integral_inside(rows[0][x], rows[1][x], rows[2][x], rows[3][x], rows[4][x], part);
}

// Row y of the view moved along y: `above` and `below` are the integrals of rows y and y + 1. Only the columns [begin -
// 2, end + 3), which a move along x reads.
void moved_row(const Plane &plane, int y, const Line &above, const Line &below, int begin, Line &moved) {
    const float *row = plane.row(y);
    for (std::size_t i = 0; i < moved.size(); ++i) {
        const int x = std::clamp(begin - 2 + int(i), plane.window.min.x, plane.window.max.x);
        const std::size_t column = std::size_t(x - plane.window.min.x);
        moved[i] = row[column] + (below[column] - above[column]);
    }
}

void add_moved_along_x(const Line &line, float part, Line &integrals, double *sums) {
    const std::size_t count = line.size() - 5;
    for (std::size_t i = 0; i < integrals.size(); ++i)
        integrals[i] = integral_inside(line[i], line[i + 1], line[i + 2], line[i + 3], line[i + 4], part);
    for (std::size_t i = 0; i < count; ++i) sums[i] += line[i + 2] + (integrals[i + 1] - integrals[i]);
}

// Adds rows [begin, end) of the target.
void add_rows(const Plane &plane, const AxisMove &across, const AxisMove &down, int begin, int end,
              const Windows &target, double *sums) {
    const std::size_t count = std::size_t(across.end - across.begin);
    Line above(plane.width()), below(plane.width()), line(count + 5), integrals(count + 1);
    integrate_row(plane, begin + down.whole, down.part, above);
    for (int y = begin; y < end; ++y) {
        integrate_row(plane, y + down.whole + 1, down.part, below);
        moved_row(plane, y + down.whole, above, below, across.begin + across.whole, line);
        add_moved_along_x(line, across.part, integrals, sums + target.index(Imath::V2i(across.begin, y)));
        std::swap(above, below);
    }
}

void take_ids(const Image &view, std::size_t channel, const Windows &target, double *ids) {
    for (int y = target.data.min.y; y <= target.data.max.y; ++y)
        for (int x = target.data.min.x; x <= target.data.max.x; ++x)
            if (view.windows.data.intersects(Imath::V2i(x, y)))
                ids[target.index(Imath::V2i(x, y))] = std::bit_cast<std::uint32_t>(view.at(channel, x, y));
}

// Adds the id and coverage pairs of row y of the target, weighted by the areas of the view's pixels that its pixels
// cover.
void add_mattes(const Image &view, const AxisMove &across, const AxisMove &down, int y, Accumulation &to) {
    const Imath::Box2i &from = view.windows.data;
    for (const Matte &matte : find_mattes(view.channels)) {
        const auto own = std::ranges::find(to.mattes, matte.name, &Accumulation::SummedMatte::name);
        for (int x = across.begin; x < across.end && own != to.mattes.end(); ++x)
            for (int corner = 0; corner < 4; ++corner) {
                const int right = corner % 2, below = corner / 2;
                const double area =
                    double(right ? across.part : 1 - across.part) * double(below ? down.part : 1 - down.part);
                const int u = std::clamp(x + across.whole + right, from.min.x, from.max.x),
                          v = std::clamp(y + down.whole + below, from.min.y, from.max.y);
                for (const Matte::Rank &rank : matte.ranks)
                    own->pixels[to.windows.index(Imath::V2i(x, y))].add(
                        view.at(rank.id, u, v), area * double(view.at(rank.coverage, u, v)));
            }
    }
}

void average_mattes(const Accumulation &accumulation, Image &image) {
    const std::vector<Matte> mattes = find_mattes(image.channels);
    for (std::size_t m = 0; m < mattes.size(); ++m)
        parallel_ranges(image.windows.pixels(), 4096, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                IdCoverage sum = accumulation.mattes[m].pixels[i];
                const auto pairs = sum.ranked();
                for (std::size_t r = 0; r < mattes[m].ranks.size(); ++r) {
                    const bool none = r >= pairs.size() || accumulation.covered[i] == 0;
                    image.plane(mattes[m].ranks[r].id)[i] = none ? 0 : pairs[r].id;
                    image.plane(mattes[m].ranks[r].coverage)[i] =
                        none ? 0 : float(pairs[r].coverage / accumulation.covered[i]);
                }
            }
        });
}

// The index of each channel in the view.
std::vector<std::size_t> channels_in(const Image &view, const std::vector<Channel> &channels,
                                     const std::string &file) {
    std::vector<std::size_t> indices;
    for (const Channel &channel : channels) {
        const std::size_t found = find_channel(view.channels, channel.name);
        if (found == npos) throw Error(fmt::format("{}: has no channel {}", file, channel.name));
        if ((view.channels[found].type == PixelType::uint32) != (channel.type == PixelType::uint32))
            throw Error(
                fmt::format("{}: channel {} has another type than in the first view", file, channel.name));
        indices.push_back(found);
    }
    return indices;
}

} // namespace

Accumulation start_accumulation(const Windows &windows, const std::vector<Channel> &channels) {
    Accumulation accumulation;
    accumulation.windows = windows;
    accumulation.covered.resize(windows.pixels());
    for (const Channel &channel : channels)
        if (!is_depth(channel.name)) accumulation.channels.push_back(channel);
    accumulation.sums.resize(accumulation.channels.size() * windows.pixels());
    for (const Matte &matte : find_mattes(accumulation.channels))
        accumulation.mattes.push_back({matte.name, std::vector<IdCoverage>(windows.pixels())});
    return accumulation;
}

void accumulate(Accumulation &accumulation, const Image &view, const Imath::V2d &shift,
                const std::string &file) {
    const Windows &target = accumulation.windows;
    const Imath::Box2i &from = view.windows.data, &to = target.data;
    const AxisMove across = axis_move(shift.x, from.min.x, from.max.x, to.min.x, to.max.x);
    const AxisMove down = axis_move(shift.y, from.min.y, from.max.y, to.min.y, to.max.y);
    const std::vector<std::size_t> channels = channels_in(view, accumulation.channels, file);
    const bool first = accumulation.views++ == 0;
    const bool seen = across.begin < across.end && down.begin < down.end;
    constexpr std::size_t rows_a_task = 16;
    const std::size_t rows = seen ? std::size_t(down.end - down.begin) : 0;
    parallel_ranges(rows, rows_a_task, [&](std::size_t begin, std::size_t end) {
        const int top = down.begin + int(begin), bottom = down.begin + int(end);
        for (std::size_t k = 0; k < channels.size(); ++k)
            if (!holds_ids(accumulation.channels[k]))
                add_rows({view.plane(channels[k]).data(), from}, across, down, top, bottom, target,
                         accumulation.sums.data() + k * target.pixels());
        for (int y = top; y < bottom && !accumulation.mattes.empty(); ++y)
            add_mattes(view, across, down, y, accumulation);
        for (int y = top; y < bottom; ++y)
            for (int x = across.begin; x < across.end; ++x)
                ++accumulation.covered[target.index(Imath::V2i(x, y))];
    });
    for (std::size_t k = 0; first && k < channels.size(); ++k)
        if (accumulation.channels[k].type == PixelType::uint32)
            take_ids(view, channels[k], target, accumulation.sums.data() + k * target.pixels());
}

Image average(const Accumulation &accumulation) {
    Image image(accumulation.windows, accumulation.channels);
    const std::size_t pixels = image.windows.pixels();
    for (std::size_t k = 0; k < image.channels.size(); ++k) {
        const double *sums = accumulation.sums.data() + k * pixels;
        const std::span<float> values = image.plane(k);
        const bool ids = image.channels[k].type == PixelType::uint32;
        parallel_ranges(pixels, 65536, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                if (ids)
                    values[i] = std::bit_cast<float>(std::uint32_t(sums[i]));
                else if (accumulation.covered[i] > 0)
                    values[i] = float(sums[i] / accumulation.covered[i]);
            }
        });
    }
    average_mattes(accumulation, image);
    return image;
}

namespace {

// Mean of the finite values among the neighbours of pixel (x, y), 0 if there are none.
float mean_of_neighbours(const Image &image, std::size_t channel, int x, int y) {
    const Imath::Box2i &window = image.windows.data;
    double sum = 0;
    int count = 0;
    for (int v = std::max(y - 1, window.min.y); v <= std::min(y + 1, window.max.y); ++v)
        for (int u = std::max(x - 1, window.min.x); u <= std::min(x + 1, window.max.x); ++u) {
            const float value = image.at(channel, u, v);
            if (!std::isfinite(value)) continue;
            sum += value;
            ++count;
        }
    return count == 0 ? 0.0f : float(sum / count);
}

} // namespace

std::size_t fill_nonfinite(Image &image, const std::vector<Channel> &channels) {
    const Windows &w = image.windows;
    std::vector<std::pair<std::size_t, float>> repairs; // applied at the end, computed from original values
    for (const Channel &channel : channels) {
        const std::size_t k = find_channel(image.channels, channel.name);
        if (k == npos || holds_ids(channel)) continue;
        const std::span<const float> plane = image.plane(k);
        for (std::size_t i = 0; i < plane.size(); ++i) {
            if (std::isfinite(plane[i])) continue;
            const Imath::V2i at = w.pixel(i);
            repairs.emplace_back(k * w.pixels() + i, mean_of_neighbours(image, k, at.x, at.y));
        }
    }
    for (const auto &[index, value] : repairs) image.values[index] = value;
    return repairs.size();
}

Image with_transparent_surroundings(const Image &image) {
    Windows windows = image.windows;
    windows.data.extendBy(windows.display);
    Image grown(windows, image.channels);
    const Imath::Box2i &inside = image.windows.data;
    for (std::size_t k = 0; k < image.channels.size(); ++k)
        for (int y = inside.min.y; y <= inside.max.y; ++y)
            for (int x = inside.min.x; x <= inside.max.x; ++x) grown.at(k, x, y) = image.at(k, x, y);
    return grown;
}

} // namespace sparselens
