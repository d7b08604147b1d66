#include "dof/lens/lens_gather_reference.h"

#include "base/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sparselens {

namespace {

constexpr long double infinity = std::numeric_limits<long double>::infinity();

// Of the weight of all lens points: what covers less is not seen at all.
constexpr long double least_coverage = 1e-6L;

// What rounding to halves leaves of full coverage, and of nothing: lens_gather_reference.h.
constexpr long double opaque = 0.9995L, clear = 1.0L / 2048;

struct Placed {
    long double x, y, coc, z, alpha; // EXR coordinates, pixels, scene units
    std::uint64_t source;
    bool background;
};

long double coc_at(const ThinLens &lens, long double z) {
    const long double rf = (long double)lens.radius * lens.focal_px, d = lens.focus;
    if (std::isinf(d)) return -rf / z;
    return std::isinf(z) ? rf / d : rf / d * ((z - d) / z);
}

long double alpha_of(const Ldi &ldi, std::uint64_t sample) {
    return ldi.alpha() == npos ? 1.0L : (long double)std::clamp(ldi.values[ldi.alpha()][sample], 0.0f, 1.0f);
}

// All samples, and inside the window the backgrounds behind what is not opaque, front to back.
std::vector<Placed> place_samples(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window) {
    std::vector<Placed> placed;
    for (int row = ldi.windows.data.min.y; row <= ldi.windows.data.max.y; ++row)
        for (int column = ldi.windows.data.min.x; column <= ldi.windows.data.max.x; ++column) {
            const std::size_t pixel = ldi.windows.index(column, row);
            const long double x = column + 0.5L, y = row + 0.5L;
            long double passed = 1;
            for (const std::uint64_t i : ldi.pixel(pixel)) {
                const long double dx = ldi.dx.empty() ? 0 : ldi.dx[i], dy = ldi.dy.empty() ? 0 : ldi.dy[i];
                const long double z = ldi.z[i], alpha = alpha_of(ldi, i);
                placed.push_back({x + dx, y + dy, coc_at(lens, z), z, alpha < opaque ? alpha : 1, i, false});
                passed *= 1 - alpha;
            }
            if (passed < clear || !window.intersects(Imath::V2i(column, row))) continue;
            if (!ldi.pixel(pixel).empty()) {
                const Placed last = placed.back();
                placed.push_back({last.x, last.y, last.coc, infinity, 1, 0, true});
            }
            placed.push_back({x, y, coc_at(lens, infinity), infinity, 1, 0, true});
        }
    std::stable_sort(placed.begin(), placed.end(), [](const Placed &a, const Placed &b) {
        return a.z != b.z ? a.z < b.z : !a.background && b.background;
    });
    return placed;
}

// A sample that a lens point sees, or sees by one way of rounding.
struct Met {
    const Placed *sample;
    bool seen, sure;
    long double passes; // of its light, the holdout
};

struct Pixel {
    int x, y;
    long double extent; // the largest coordinate there is: a float knows a place to some 1e-7 of it
    const Holdout *holdout;
};

// How far one coordinate of a sample is from the edge of its square, inside; and how far rounding may move it.
struct Margin {
    long double inside, unclear;
    bool outside() const { return inside < -unclear; }
};

Margin margin(long double sample, long double displaced, long double looked_at, long double extent) {
    return {0.5L - std::abs(sample + displaced - looked_at), 5e-7L * extent + 1e-6L * std::abs(displaced)};
}

// What the lens point meets in the pixel, front to back, up to the first that certainly hides all else.
void meet(std::span<const Placed> samples, const LensSample &point, const Pixel &pixel,
          std::vector<Met> &met) {
    met.clear();
    const long double x = pixel.x + 0.5L - (long double)point.pixel_x,
                      y = pixel.y + 0.5L - (long double)point.pixel_y;
    for (const Placed &s : samples) {
        const Margin across = margin(s.x, s.coc * (long double)point.x, x, pixel.extent);
        if (across.outside()) continue;
        const Margin down = margin(s.y, s.coc * (long double)point.y, y, pixel.extent);
        if (down.outside()) continue;
        const bool sure = across.inside > across.unclear && down.inside > down.unclear;
        const bool held_out = pixel.holdout && !s.background;
        met.push_back({&s, across.inside > 0 && down.inside > 0, sure,
                       held_out ? (long double)pixel.holdout->passes(pixel.x, pixel.y, double(s.z)) : 1});
        if (sure && s.alpha == 1) return;
    }
}

// All of them over each other, of each light(m); at the least and at the most by leaving out what is not sure.
template <typename Light>
ReferenceValue composite(std::span<const Met> met, const Light &light) {
    ReferenceValue sum;
    for (std::size_t i = met.size(); i-- > 0;) {
        const Met &m = met[i];
        const long double own = light(m), behind = 1 - m.sample->alpha;
        const ReferenceValue over{own + behind * sum.value, own + behind * sum.least,
                                  own + behind * sum.most};
        sum = {m.seen ? over.value : sum.value, m.sure ? over.least : std::min(over.least, sum.least),
               m.sure ? over.most : std::max(over.most, sum.most)};
    }
    return sum;
}

void add(ReferenceValue &to, long double weight, const ReferenceValue &value) {
    to.value += weight * value.value;
    to.least += weight * value.least;
    to.most += weight * value.most;
}

// What one pixel gathers of one channel.
struct Gathered {
    ReferenceValue light;
    // Light per coverage of the samples met. The pixel's is a mean of theirs.
    long double darkest = infinity, brightest = -infinity;
};

// Light by coverage; `flattened` where nothing is covered.
ReferenceValue normalised(const Gathered &of, const ReferenceValue &coverage, long double total,
                          long double flattened) {
    const long double none = least_coverage * total;
    const ReferenceValue &light = of.light;
    ReferenceValue mean{coverage.value > none ? light.value / coverage.value : flattened, 0, 0};
    if (coverage.most <= none) return {flattened, flattened, flattened};
    const auto ratio = [&](long double value, long double by) { return by > none ? value / by : infinity; };
    mean.least = light.least < 0 ? of.darkest : ratio(light.least, coverage.most);
    mean.most = light.most < 0 ? of.brightest : ratio(light.most, coverage.least);
    mean.least = std::min(std::max(mean.least, of.darkest), mean.value);
    mean.most = std::max(std::min(mean.most, of.brightest), mean.value);
    if (coverage.least > none) return mean;
    return {mean.value, std::min(mean.least, flattened), std::max(mean.most, flattened)};
}

// The pixel seen without a lens.
long double flattened(const Ldi &ldi, std::size_t channel, const Pixel &pixel) {
    long double passed = 1, sum = 0;
    for (const std::uint64_t i : ldi.pixel(ldi.windows.index(pixel.x, pixel.y))) {
        const long double passes =
            pixel.holdout ? (long double)pixel.holdout->passes(pixel.x, pixel.y, double(ldi.z[i])) : 1;
        sum += passed * passes * (long double)ldi.values[channel][i];
        passed *= 1 - alpha_of(ldi, i);
    }
    return sum;
}

long double front_id(const Ldi &ldi, std::size_t channel, const Pixel &pixel) {
    const SampleRange samples = ldi.pixel(ldi.windows.index(pixel.x, pixel.y));
    return samples.empty() ? 0 : (long double)ldi.values[channel][samples.front()];
}

// The channels of a pixel; `sure` is set to whether each lens point certainly sees what it sees.
std::vector<ReferenceValue> gather(const Ldi &ldi, std::span<const Placed> samples,
                                   std::span<const LensSample> points, const Pixel &pixel, char &sure) {
    std::vector<Gathered> channels(ldi.channels.size());
    ReferenceValue coverage;
    long double total = 0;
    std::vector<Met> met;
    sure = 1;
    for (const LensSample &point : points) {
        meet(samples, point, pixel, met);
        if (!std::ranges::all_of(met, &Met::sure)) sure = 0;
        total += (long double)point.weight;
        add(coverage, point.weight, composite(met, [](const Met &m) { return m.sample->alpha; }));
        for (std::size_t k = 0; k < channels.size(); ++k) {
            const auto light = [&](const Met &m) {
                return m.sample->background ? 0 : m.passes * (long double)ldi.values[k][m.sample->source];
            };
            add(channels[k].light, point.weight, composite(met, light));
            for (const Met &m : met) {
                if (m.sample->alpha == 0 && light(m) == 0) continue;
                channels[k].darkest = std::min(channels[k].darkest, light(m) / m.sample->alpha);
                channels[k].brightest = std::max(channels[k].brightest, light(m) / m.sample->alpha);
            }
        }
    }
    std::vector<ReferenceValue> values(channels.size());
    for (std::size_t k = 0; k < channels.size(); ++k) {
        const long double id = front_id(ldi, k, pixel);
        values[k] = holds_ids(ldi.channels[k])
                        ? ReferenceValue{id, id, id}
                        : normalised(channels[k], coverage, total, flattened(ldi, k, pixel));
        if (sure) values[k].least = values[k].most = values[k].value;
    }
    return values;
}

} // namespace

long double ReferenceValue::off(float other) const {
    const long double outside = std::max({least - other, other - most, 0.0L});
    return std::isfinite(other) ? outside : infinity;
}

double ReferencePicture::unsure_share() const {
    return double(std::ranges::count(sure, false)) / double(sure.size());
}

ReferencePicture lens_gather_reference(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window,
                                       std::span<const LensSample> points, const Holdout *holdout) {
    const std::vector<Placed> samples = place_samples(ldi, lens, window);
    ReferencePicture picture{ldi.windows, {}, {}};
    picture.windows.data = window;
    const std::size_t pixels = picture.windows.pixels(), channels = ldi.channels.size();
    picture.values.resize(channels * pixels);
    std::vector<char> sure(pixels); // of its own: bits of a vector<bool> cannot be written by two threads
    parallel_for(pixels, [&](std::size_t i) {
        const Imath::V2i at = picture.windows.pixel(i);
        const Pixel pixel{at.x, at.y, (long double)std::max(ldi.windows.width(), ldi.windows.height()),
                          holdout};
        const auto values = gather(ldi, samples, points, pixel, sure[i]);
        for (std::size_t k = 0; k < channels; ++k) picture.values[k * pixels + i] = values[k];
    });
    picture.sure.assign(sure.begin(), sure.end());
    return picture;
}

} // namespace sparselens
