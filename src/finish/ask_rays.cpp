#include "finish/ask_rays.h"

#include "finish/tuning.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace sparselens {

namespace {

// Pixels that get the same number of rays: how many there are, the sum of their errors with one ray each, and the sum
// of their samples.
struct Part {
    double pixels = 0, error = 0, samples = 0;

    Part &operator+=(const Part &other) {
        pixels += other.pixels;
        error += other.error;
        samples += other.samples;
        return *this;
    }
};

// `scale`: the rays that a pixel of error 1 needs.
struct Plan {
    double fall, scale;

    double needed(const Part &part) const { // rays per pixel
        const double best = scale * std::pow(part.error / part.pixels, 1 / (1 + fall));
        return std::max(part.samples / part.pixels, std::min(best, FinishTuning::most_rays));
    }
    double error(const Part &part) const { return part.error * std::pow(needed(part), -fall); }
    // The error, plus a price for each ray. needed() makes this least.
    double cost(const Part &part) const {
        return error(part) + fall * std::pow(scale, -1 - fall) * part.pixels * needed(part);
    }
};

Plan plan_of(const std::vector<Part> &parts, double fall, double rays_wanted, double goal) {
    double least = -30, most = 60; // logarithms of the scale
    for (int i = 0; i < 60; ++i) {
        const Plan plan{fall, std::exp((least + most) / 2)};
        double pixels = 0, rays = 0, error = 0;
        for (const Part &part : parts) {
            pixels += part.pixels;
            rays += part.pixels * plan.needed(part);
            error += plan.error(part);
        }
        const bool enough = rays_wanted > 0 ? rays >= rays_wanted * pixels : error <= goal * pixels;
        (enough ? most : least) = std::log(plan.scale);
    }
    return {fall, std::exp(most)};
}

// Cuts a lattice of blocks in two, then one of the pieces, and so on, each time where it saves most.
std::vector<PositionBox> pieces_of(const ArrayGrid &lattice, const Plan &plan,
                                   const std::function<Part(const PositionBox &)> &part_of) {
    std::vector<PositionBox> pieces{lattice.box()};
    const double worth = FinishTuning::least_saving * plan.cost(part_of(pieces[0]));
    while (pieces.size() < FinishTuning::most_pieces) {
        double most = worth;
        std::size_t cut = 0;
        PositionBox first, second;
        for (std::size_t p = 0; p < pieces.size(); ++p) {
            const double whole = plan.cost(part_of(pieces[p]));
            for (const auto axis : {&Position::column, &Position::row})
                for (int at = pieces[p].min.*axis; at < pieces[p].max.*axis; ++at) {
                    PositionBox before = pieces[p], after = before;
                    before.max.*axis = at;
                    after.min.*axis = at + 1;
                    const double saved = whole - plan.cost(part_of(before)) - plan.cost(part_of(after));
                    if (saved <= most) continue;
                    most = saved, cut = p, first = before, second = after;
                }
        }
        if (most == worth) break;
        pieces[cut] = first;
        pieces.push_back(second);
    }
    return pieces;
}

} // namespace

AskedRays ask_rays(const ErrorEstimate &error, const RayCounts &samples, const Grid &grid,
                   const Imath::Box2i &pixels, double rays, double goal) {
    const double fall = decibels(error) ? fall_of(error, samples.mean) : 1;
    const Grid inside(pixels);
    const Tiles blocks(pixels, FinishTuning::ask_block_px);
    std::vector<Part> parts(blocks.count());
    double of_map = 0; // the mean of the map, which has no error below 0, and so exceeds the picture's mean
    for (std::size_t k = 0; k < inside.size(); ++k) {
        const Imath::V2i pixel = inside.pixel(k);
        const std::size_t i = grid.index(pixel);
        const auto [n, m] = samples.at(i);
        of_map += double(error.map[i]) / double(inside.size());
        parts[blocks.tile_of(pixel)] +=
            {1, double(error.map[i]) * std::pow(double(n + m), fall), double(n + m)};
    }
    if (error.mean > 0) goal *= of_map / error.mean;
    const Plan plan = plan_of(parts, fall, rays, goal);
    AskedRays asked{Values(grid.size(), 0.0f), {}};
    const auto more = [](const Plan &by, const Part &part) {
        return by.needed(part) - part.samples / part.pixels;
    };
    for (std::size_t k = 0; k < inside.size(); ++k)
        asked.more[grid.index(inside.pixel(k))] = float(more(plan, parts[blocks.tile_of(inside.pixel(k))]));

    const ArrayGrid lattice(blocks.columns(), blocks.rows());
    const auto part_of = [&](const PositionBox &box) {
        Part sum;
        for (int y = box.min.row; y <= box.max.row; ++y)
            for (int x = box.min.column; x <= box.max.column; ++x)
                sum += parts[lattice.index(Position(x, y))];
        return sum;
    };
    const std::vector<PositionBox> pieces = pieces_of(lattice, plan, part_of);
    std::vector<Part> together;
    for (const PositionBox &piece : pieces) together.push_back(part_of(piece));
    const Plan of_pieces = plan_of(together, fall, rays, goal);
    for (std::size_t p = 0; p < pieces.size(); ++p)
        if (const auto half = int(std::lround(more(of_pieces, together[p]) / 2)); half > 0)
            asked.rectangles.emplace_back(
                Imath::Box2i(blocks.box(pieces[p].min).min, blocks.box(pieces[p].max).max), 2 * half);
    return asked;
}

} // namespace sparselens
