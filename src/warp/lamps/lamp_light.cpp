#include "warp/lamps/lamp_light.h"

#include "base/numbers.h"
#include "deep/channel_alpha.h"
#include "lens/lamp_spread.h"
#include "lens/thin_lens.h"
#include "warp/tuning.h"

#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>

namespace sparselens {

namespace {

constexpr double farthest_move = 1 << 20; // pixels, between two views

// The samples of a lamp, and the factor on their light.
struct Change {
    std::vector<std::uint64_t> samples;
    double factor = 1;
};

class Calibration {
public:
    Calibration(std::span<const PlacedView> views, double tolerance, const Ldi &ldi)
        : views_(views), tolerance_(tolerance), ldi_(ldi), light_(ldi) {
        for (const PlacedView &view : views) lights_.emplace_back(*view.samples);
    }
    std::optional<Change> change_of(const CompactLamp &lamp) const;

private:
    using Pixels = std::vector<Imath::V2i>;

    double inverse_depth(const CompactLamp &lamp) const;
    bool has_empty(const Pixels &pixels) const;
    std::optional<Pixels> moved(std::size_t view, const Pixels &pixels, const Imath::V2i &lamp,
                                double inverse_z) const;
    std::optional<double> light_in(std::size_t view, const Pixels &pixels, double inverse_z,
                                   bool may_be_empty) const;
    std::optional<double> light_of_views(const CompactLamp &lamp, const Pixels &pixels) const;

    std::span<const PlacedView> views_;
    double tolerance_; // of 1 / z, within one surface
    const Ldi &ldi_;
    PixelLight<Ldi> light_;
    std::vector<PixelLight<ViewSamples>> lights_; // of the views
};

// 1 / z of the brightest sample of a lamp's brightest pixel.
double Calibration::inverse_depth(const CompactLamp &lamp) const {
    const ViewSamples &centre = *views_[0].samples;
    double most = -1, inverse_z = 0;
    const auto look = [&](std::uint64_t i, double light) {
        if (light <= most) return;
        most = light;
        inverse_z = 1 / double(centre.z(i));
    };
    lights_[0].visit(centre.windows.index(lamp.pixels[0]), look);
    return inverse_z;
}

bool Calibration::has_empty(const Pixels &pixels) const {
    const ViewSamples &centre = *views_[0].samples;
    return std::ranges::any_of(pixels, [&](const Imath::V2i &p) {
        return centre.windows.data.intersects(p) && centre.pixel(centre.windows.index(p)).empty();
    });
}

// Returns where a view shows what the centre view shows in these pixels around a lamp, to the nearest pixel.
std::optional<Calibration::Pixels> Calibration::moved(std::size_t view, const Pixels &pixels,
                                                      const Imath::V2i &lamp, double inverse_z) const {
    if (view == 0) return pixels;
    const Imath::V2d from = Imath::V2d(lamp) + Imath::V2d(0.5);
    const Imath::V2d by = views_[view].mapping->in_view(from, inverse_z) - from;
    if (!(by.length() < farthest_move)) return {};
    Pixels result = pixels;
    for (Imath::V2i &p : result) p += Imath::V2i(int(std::lround(by.x)), int(std::lround(by.y)));
    return result;
}

// Returns the light that a view shows in these pixels, if nothing nearer lies there. A pixel that shows nothing may not
// have been rendered.
std::optional<double> Calibration::light_in(std::size_t view, const Pixels &pixels, double inverse_z,
                                            bool may_be_empty) const {
    const ViewSamples &samples = *views_[view].samples;
    double sum = 0;
    for (const Imath::V2i &p : pixels) {
        if (!samples.windows.data.intersects(p)) return {};
        const std::size_t pixel = samples.windows.index(p);
        const SampleRange shown = samples.pixel(pixel);
        if (shown.empty() && !may_be_empty) return {};
        if (!shown.empty() && 1 / double(samples.z(shown.front())) > inverse_z + tolerance_) return {};
        sum += lights_[view].at(pixel);
    }
    return sum;
}

// Returns the mean over the views that see all of the lamp and agree with their median. The centre view and most views
// must be among these.
std::optional<double> Calibration::light_of_views(const CompactLamp &lamp, const Pixels &pixels) const {
    const double inverse_z = inverse_depth(lamp);
    const bool may_be_empty = has_empty(pixels);
    std::vector<double> lights;
    for (std::size_t v = 0; v < views_.size(); ++v) {
        const auto there = moved(v, pixels, lamp.pixels[0], inverse_z);
        const auto light = there ? light_in(v, *there, inverse_z, may_be_empty) : std::nullopt;
        if (light) lights.push_back(*light);
        if (v == 0 && !light) return {};
    }
    const double middle = median(std::vector(lights)); // of a copy, so that the lights keep their order
    const double tolerance = middle * std::min(WarpTuning::lamp_most_noise,
                                               WarpTuning::lamp_noise_of_pixels / double(lamp.pixels.size()));
    const auto differs = [&](double light) { return std::abs(light - middle) > tolerance; };
    if (differs(lights[0])) return {};
    std::erase_if(lights, differs);
    if (2 * lights.size() <= views_.size()) return {};
    return std::accumulate(lights.begin(), lights.end(), 0.0) / double(lights.size());
}

std::optional<Change> Calibration::change_of(const CompactLamp &lamp) const {
    const Pixels pixels = grown(lamp.pixels, WarpTuning::lamp_margin), own = grown(lamp.pixels, 1);
    const auto wanted = light_of_views(lamp, pixels);
    if (!wanted) return {};
    if (double(lamp.surroundings) * double(pixels.size()) > WarpTuning::lamp_most_of_surroundings * *wanted)
        return {};
    double all = 0, of_lamp = 0;
    Change change;
    for (const Imath::V2i &p : pixels)
        light_.visit(ldi_.windows.index(p), [&](std::uint64_t i, double light) {
            all += light;
            if (!(light > double(lamp.limit)) || !is_among(own, p)) return;
            of_lamp += light;
            change.samples.push_back(i);
        });
    if (!(std::abs(*wanted - all) <= WarpTuning::lamp_largest_change * of_lamp)) return {};
    if (of_lamp > 0) change.factor = 1 + (*wanted - all) / of_lamp;
    return change;
}

} // namespace

void keep_light_of_lamps(std::span<const PlacedView> views, double scale, double surface_px, Ldi &ldi) {
    if (views.size() < 2 || !(scale > 0)) return;
    const ViewSamples &centre = *views[0].samples;
    const PixelLight light(centre);
    if (!light.is_known()) return;
    const std::vector<CompactLamp> lamps = find_compact_lamps(centre.windows.grid(), light.picture());
    const Calibration calibration(views, inverse_depth_step(scale, surface_px), ldi);
    std::vector<std::optional<Change>> changes(lamps.size());
    parallel_for(lamps.size(), [&](std::size_t i) { changes[i] = calibration.change_of(lamps[i]); });
    for (std::size_t k = 0; k < ldi.channels.size(); ++k) {
        if (!is_light(ldi.channels[k]) || coverage_of(ldi.channels, k) == k) continue;
        for (const auto &change : changes) {
            if (!change) continue;
            for (const std::uint64_t i : change->samples)
                ldi.values[k][i] = float(double(ldi.values[k][i]) * change->factor);
        }
    }
}

namespace {

struct Seed {
    std::size_t pixel;
    float brightness, surroundings;
};

// Most blocks are found to have no seeds without a median.
std::vector<Seed> seeds_of(const Grid &grid, std::span<const float> brightness, const Imath::Box2i &box) {
    std::vector<float> values;
    values.reserve(std::size_t(WarpTuning::lamp_block * WarpTuning::lamp_block));
    for (int y = box.min.y; y <= box.max.y; ++y) {
        const auto row =
            brightness.subspan(grid.index(Imath::V2i(box.min.x, y)), std::size_t(box.size().x) + 1);
        values.insert(values.end(), row.begin(), row.end());
    }
    const auto [least, most] = std::ranges::minmax(values);
    if (!stands_out(most, least, LampTuning::stands_out_of_view)) return {};
    const float middle = median(values);
    std::vector<Seed> seeds;
    for (int y = box.min.y; y <= box.max.y; ++y)
        for (int x = box.min.x; x <= box.max.x; ++x) {
            const std::size_t i = grid.index(Imath::V2i(x, y));
            if (stands_out(brightness[i], middle, LampTuning::stands_out_of_view))
                seeds.push_back({i, brightness[i], middle});
        }
    return seeds;
}

class Grower {
public:
    Grower(const Grid &grid, std::span<const float> brightness)
        : grid_(grid), brightness_(brightness), group_(grid.size()) {}

    // The lamp around a seed; nothing if the seed is in a group already, or if its group is large or beside another
    // one.
    std::optional<CompactLamp> grow(const Seed &seed) {
        if (group_[seed.pixel] != 0) return {};
        CompactLamp lamp{{},
                         std::max(LampTuning::stands_out * seed.surroundings,
                                  WarpTuning::lamp_belongs_to_brightest * seed.brightness),
                         seed.surroundings};
        ++number_;
        box_ = {};
        take(seed.pixel, lamp);
        for (std::size_t next = 0; next < lamp.pixels.size(); ++next)
            if (!take_around(lamp.pixels[next], lamp)) return {};
        return lamp;
    }

private:
    void take(std::size_t pixel, CompactLamp &lamp) {
        group_[pixel] = number_;
        lamp.pixels.push_back(grid_.pixel(pixel));
        box_.extendBy(lamp.pixels.back());
    }

    bool take_around(Imath::V2i at, CompactLamp &lamp) {
        for (int y = at.y - WarpTuning::lamp_gap; y <= at.y + WarpTuning::lamp_gap; ++y)
            for (int x = at.x - WarpTuning::lamp_gap; x <= at.x + WarpTuning::lamp_gap; ++x) {
                if (!grid_.contains(Imath::V2i(x, y))) continue;
                const std::size_t i = grid_.index(Imath::V2i(x, y));
                if (!(brightness_[i] > lamp.limit) || group_[i] == number_) continue;
                if (group_[i] != 0) return false;
                take(i, lamp);
            }
        return box_.size().x < WarpTuning::largest_lamp && box_.size().y < WarpTuning::largest_lamp;
    }

    const Grid &grid_;
    std::span<const float> brightness_;
    std::vector<std::uint32_t> group_; // of each pixel, from 1; 0: none
    std::uint32_t number_ = 0;
    Imath::Box2i box_;
};

} // namespace

std::vector<CompactLamp> find_compact_lamps(const Grid &grid, std::span<const float> brightness) {
    const Tiles blocks(grid.box(), WarpTuning::lamp_block);
    std::vector<Seed> seeds =
        joined(blocks.count(), [&](std::size_t i) { return seeds_of(grid, brightness, blocks.box(i)); });
    if (seeds.empty()) return {};
    std::ranges::stable_sort(seeds, std::ranges::greater(), &Seed::brightness);
    Grower grower(grid, brightness);
    std::vector<CompactLamp> lamps;
    for (const Seed &seed : seeds)
        if (auto lamp = grower.grow(seed)) lamps.push_back(std::move(*lamp));
    return lamps;
}

} // namespace sparselens
