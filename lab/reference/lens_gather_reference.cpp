#include "lab/reference/lens_gather_reference.h"

#include "base/parallel.h"
#include "lab/reference/find_fillers_slowly.h"
#include "lab/reference/seen_slowly.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace sparselens {

namespace {

constexpr long double infinity = std::numeric_limits<long double>::infinity();

// Share of the weight of all lens points. A pixel with less coverage counts as empty.
constexpr long double least_coverage = 1e-6L;

// Composites all samples with light(m). The least and the most are the bounds if unsure samples may be left out.
template <typename Light>
ReferenceValue composite(const std::vector<Met> &met, const Light &light) {
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

// Which weight of a lens point applies to a channel.
enum class Kind { red, green, blue, coverage, data };

Kind kind_of(const Channel &channel) {
    const std::string part = channel.name.substr(channel.name.rfind('.') + 1);
    if (channel.kind != ChannelKind::light || holds_ids(channel)) return Kind::data;
    if (part == "A") return Kind::coverage;
    return part == "R" ? Kind::red : part == "G" ? Kind::green : part == "B" ? Kind::blue : Kind::data;
}

bool is_colour(Kind kind) { return kind == Kind::red || kind == Kind::green || kind == Kind::blue; }

long double weight_of(const LensSample &point, Kind kind, const Met &met) {
    const long double weight = is_colour(kind) ? (long double)point.rgb[std::size_t(kind)] : 1;
    if (kind == Kind::data) return weight;
    const bool in_front = met.sample->shows().coc < 0 && !met.sample->background;
    return weight *
           (long double)(in_front ? point.in_front : point.behind)[is_colour(kind) ? std::size_t(kind) : 1];
}

template <typename Light>
ReferenceValue composite(std::span<const Way> ways, const Light &light) {
    ReferenceValue sum{0, infinity, -infinity};
    for (const Way &way : ways) {
        const ReferenceValue value = composite(way.met, light);
        if (way.is) sum.value = value.value;
        sum.least = std::min(sum.least, value.least);
        sum.most = std::max(sum.most, value.most);
    }
    return sum;
}

void add(ReferenceValue &to, long double weight, const ReferenceValue &value) {
    to.value += weight * value.value;
    to.least += weight * value.least;
    to.most += weight * value.most;
}

struct SlowLens {
    std::span<const LensSample> points;
    const CatEye *cat_eye; // null: no cat-eye
    double pixel_aspect;

    bool passes(const LensSample &point, const Pixel &pixel) const {
        const Imath::V2d u(double(point.x), -double(point.y) / pixel_aspect);
        return !cat_eye || cat_eye->passes(u, {pixel.x + 0.5, pixel.y + 0.5});
    }
    bool darkens(const Channel &channel) const {
        return cat_eye && cat_eye->darkens() && is_colour(kind_of(channel));
    }
    ReferenceValue darkened(const ReferenceValue &value, const Pixel &pixel) const {
        const Imath::V2i at(pixel.x, pixel.y);
        const long double left = cat_eye->shares(CatEye::Light::evenly, {at, at})[0];
        return {left * value.value, left * value.least, left * value.most};
    }
};

// The sums that one pixel gathers for one channel.
struct Gathered {
    ReferenceValue light, coverage;
    // Bounds of light per coverage of the samples met. The pixel's value is a mean of theirs.
    long double darkest = infinity, brightest = -infinity;
};

// Light divided by coverage; `flattened` if nothing is covered.
ReferenceValue normalised(const Gathered &of, long double total, long double flattened) {
    const ReferenceValue &coverage = of.coverage;
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

// The pixel as seen without a lens.
long double flattened(const Ldi &ldi, std::size_t channel, const Pixel &pixel) {
    long double passed = 1, sum = 0;
    for (const std::uint64_t i : ldi.pixel(ldi.windows.index(Imath::V2i(pixel.x, pixel.y)))) {
        const long double passes =
            pixel.holdout ? (long double)pixel.holdout->passes(pixel.x, pixel.y, double(ldi.z[i])) : 1;
        sum += passed * passes * (long double)ldi.values[channel][i];
        passed *= 1 - alpha_of(ldi, i);
    }
    return sum;
}

long double front_id(const Ldi &ldi, std::size_t channel, const Pixel &pixel) {
    const SampleRange samples = ldi.pixel(ldi.windows.index(Imath::V2i(pixel.x, pixel.y)));
    return samples.empty() ? 0 : (long double)ldi.values[channel][samples.front()];
}

long double light_of(const Ldi &ldi, std::size_t channel, const Met &met) {
    if (met.sample->background) return 0;
    const std::vector<float> &values = ldi.values[channel];
    if (!met.sample->filler) return met.passes * (long double)values[met.sample->source];
    long double sum = 0;
    for (const Filler::Part &part : met.sample->filler->parts())
        sum += (long double)part.share * (long double)values[part.sample];
    return met.passes * sum;
}

// Adds what a lens point sees in these ways. `darkened`: divides by the number of lens points instead of their weights.
void add_seen(Gathered &to, const Ldi &ldi, std::size_t channel, const LensSample &point,
              std::span<const Way> ways, bool darkened) {
    const Kind kind = kind_of(ldi.channels[channel]);
    const auto weight = [&](const Met &m) { return weight_of(point, kind, m); };
    const auto counted = [&](const Met &m) { return darkened ? 1 : weight(m); };
    const auto light = [&](const Met &m) { return weight(m) * light_of(ldi, channel, m); };
    add(to.coverage, point.weight,
        composite(ways, [&](const Met &m) { return counted(m) * m.sample->alpha; }));
    add(to.light, point.weight, composite(ways, light));
    for (const Way &way : ways)
        for (const Met &m : way.met) {
            if (m.sample->alpha == 0 && light(m) == 0) continue;
            const long double seen = light(m) / (counted(m) * m.sample->alpha);
            to.darkest = std::min(to.darkest, seen);
            to.brightest = std::max(to.brightest, seen);
        }
}

// The channels of a pixel. `unsure` is set to the number of lens points for which rounding decides what they see.
std::vector<ReferenceValue> gather(const Ldi &ldi, const Scene &scene, const SlowLens &lens,
                                   const Pixel &pixel, std::uint32_t &unsure) {
    std::vector<Gathered> channels(ldi.channels.size());
    long double total = 0;
    unsure = 0;
    for (const LensSample &point : lens.points) {
        total += (long double)point.weight;
        if (!lens.passes(point, pixel)) continue;
        const std::vector<Way> ways = ways_to_see(scene, point, pixel);
        const auto sure = [](const Way &way) { return std::ranges::all_of(way.met, &Met::sure); };
        unsure += ways.size() > 1 || !std::ranges::all_of(ways, sure);
        for (std::size_t k = 0; k < channels.size(); ++k)
            add_seen(channels[k], ldi, k, point, ways, lens.darkens(ldi.channels[k]));
    }
    std::vector<ReferenceValue> values(channels.size());
    for (std::size_t k = 0; k < channels.size(); ++k) {
        const long double id = front_id(ldi, k, pixel);
        values[k] = holds_ids(ldi.channels[k]) ? ReferenceValue{id, id, id}
                                               : normalised(channels[k], total, flattened(ldi, k, pixel));
        if (unsure == 0) values[k].least = values[k].most = values[k].value;
        if (lens.darkens(ldi.channels[k])) values[k] = lens.darkened(values[k], pixel);
    }
    return values;
}

Rounding rounding_of(const Scene &scene, long double widest, long double extent) {
    Rounding rounding{extent, 128, 1, 0, 0};
    while (rounding.lens_unit < widest * 0.999L) rounding.lens_unit *= 2;
    while (widest > 0 && rounding.lens_unit / 2 >= widest * 0.999L) rounding.lens_unit /= 2;
    long double coc = 0;
    for (const auto *some : {&scene.samples, &scene.fillers, &scene.solids})
        for (const Placed &s : *some) coc = std::max({coc, std::abs(s.coc), std::abs(s.image_coc)});
    while ((2 * coc * rounding.lens_unit + 38.5L) * rounding.unit > 32767 && rounding.unit > 4)
        rounding.unit /= 2;
    const std::size_t numbers = scene.samples.size() + scene.fillers.size();
    const long double code = 1 / std::exp2(30 - std::floor(std::log2((long double)numbers + 1)) - 0.01L);
    const auto nearest = scene.samples.empty()
                             ? 0
                             : (long double)scene.lens.radius * scene.lens.focal_px / scene.samples.front().z;
    rounding.depth = code * (nearest + 1);
    rounding.image = code * (2 * coc * rounding.lens_unit + 3);
    return rounding;
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
                                       std::span<const LensSample> points, const Holdout *holdout,
                                       const CatEye *cat_eye) {
    const SlowLens by{points, cat_eye, lens.pixel_aspect};
    const std::vector<Filler> fillers = find_fillers_slowly(ldi, lens, window);
    const Scene scene = place_scene(ldi, lens, window, fillers);
    ReferencePicture picture{ldi.windows, {}, {}};
    picture.windows.data = window;
    const std::size_t pixels = picture.windows.pixels(), channels = ldi.channels.size();
    picture.values.resize(channels * pixels);
    std::vector<std::uint32_t> unsure(pixels); // number of lens points
    long double widest = 0;                    // largest coordinate of them
    for (const LensSample &point : points)
        widest = std::max({widest, (long double)std::abs(point.x), (long double)std::abs(point.y)});
    const Rounding rounding =
        rounding_of(scene, widest, (long double)std::max(ldi.windows.width(), ldi.windows.height()));
    parallel_for(pixels, [&](std::size_t i) {
        const Imath::V2i at = picture.windows.pixel(i);
        const auto middle = [](int p, int first) { return first + (p - first) / 64 * 64 + 32; };
        const Pixel pixel{
            at.x, at.y, {middle(at.x, window.min.x), middle(at.y, window.min.y)}, rounding, holdout};
        const auto values = gather(ldi, near(scene, pixel, widest), by, pixel, unsure[i]);
        for (std::size_t k = 0; k < channels; ++k) picture.values[k * pixels + i] = values[k];
    });
    for (const std::uint32_t count : unsure) {
        picture.sure.push_back(count == 0);
        picture.unsure_points += double(count);
    }
    picture.unsure_points /= double(pixels) * double(points.size());
    return picture;
}

} // namespace sparselens
