#include "dof/lens/sharpen.h"

#include "base/parallel.h"
#include "deep/build.h"
#include "dof/footprints/interpolation_blur.h"
#include "dof/tuning.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sparselens {

namespace {

constexpr int noise_block = GatherTuning::cell_px; // pixels across a block, which has one noise level

class Sharpener {
public:
    Sharpener(const Ldi &ldi, const ThinLens &lens, const BlockedSamples &samples, const SharpenLooks *looks)
        : ldi_(ldi), lens_(lens), samples_(samples), looks_(looks), rgb_(find_rgb(ldi.channels)),
          blur_(looks ? &looks->aperture : nullptr) {}
    bool usable() const { return all_found(rgb_); }

    // The weights with which a sample may exchange light with its neighbours.
    struct Weights { // float, because there is one per sample
        float horizontal, vertical;
        float most; // share of all this that it may give away
        double along(std::size_t neighbour) const { return double(neighbour < 2 ? horizontal : vertical); }
    };
    // The weights of the samples of some rows, and of the row on either side.
    struct Band {
        std::uint64_t first; // sample
        std::vector<Weights> weights;
        std::vector<SurfaceNeighbours> neighbours; // of those that have weights
        std::vector<std::uint32_t> number;         // [sample]: index of its entry in `neighbours`
        const Weights &of(std::uint64_t sample) const { return weights[sample - first]; }
        const SurfaceNeighbours &beside(std::uint64_t sample) const {
            return neighbours[number[sample - first]];
        }
    };

    // Whether samples in the columns x to last_x and the rows y to last_y may have weights.
    bool near_focus(int x, int y, int last_x, int last_y) const;
    void measure_noise();
    Band weigh(int top, int bottom) const; // rows [top, bottom); after measure_noise()
    // Calls visit(sample, x, y) for the samples of rows [top, bottom) that may have weights, and perhaps for others.
    template <typename Visit>
    void for_each_near_focus(int top, int bottom, const Visit &visit) const;
    // The change of sample i, in the rows of the band: its new value is the sum of the terms.
    std::array<Term, 5> terms(const Band &band, std::uint64_t i) const;

private:
    struct Seen {          // through the middle of the lens
        Imath::V2d coc;    // along each axis
        Imath::V2d offset; // off the grid, pixels
    };
    Seen seen(const MergedSample &place, int x, int y) const;
    Weights weights(std::uint64_t i, int x, int y, SurfaceNeighbours &n) const;
    double detail(std::uint64_t i, const SurfaceNeighbours &n) const;
    bool was_seen(std::size_t pixel) const {
        return !looks_ || !looks_->seen || looks_->seen->intersects(ldi_.windows.pixel(pixel));
    }
    double second_difference(std::uint64_t i, std::uint64_t a, std::uint64_t b, std::size_t k) const {
        const std::vector<float> &v = ldi_.values[rgb_[k]];
        return double(v[a]) - 2 * double(v[i]) + double(v[b]);
    }

    const Ldi &ldi_;
    const ThinLens &lens_;
    const BlockedSamples &samples_;
    const SharpenLooks *looks_;
    std::array<std::size_t, 3> rgb_;
    std::vector<double> noise_; // of each block, as detail() measures it
    InterpolationBlur blur_;
};

// The root of the sum of the squared second differences of R, G and B along both axes.
double Sharpener::detail(std::uint64_t i, const SurfaceNeighbours &n) const {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const double h = n.horizontal > 0 ? second_difference(i, n.sample[0], n.sample[1], k) : 0;
        const double v = n.vertical > 0 ? second_difference(i, n.sample[2], n.sample[3], k) : 0;
        sum += double(n.horizontal) * h * h + double(n.vertical) * v * v;
    }
    return std::sqrt(sum);
}

bool Sharpener::near_focus(int x, int y, int last_x, int last_y) const {
    constexpr int size = BlockedSamples::size;
    for (int row = y / size; row <= last_y / size; ++row)
        for (int column = x / size; column <= last_x / size; ++column) {
            const SampleBlock &block = samples_.blocks[std::size_t(row * samples_.columns + column)];
            if (block.begin < block.end && blur_.any(block.coc_min, block.coc_max, lens_.pixel_aspect))
                return true;
        }
    return false;
}

void Sharpener::measure_noise() {
    const int width = ldi_.windows.width(), height = ldi_.windows.height();
    const int columns = (width + noise_block - 1) / noise_block,
              rows = (height + noise_block - 1) / noise_block;
    noise_.assign(std::size_t(columns * rows), 0);
    parallel_for(noise_.size(), [&](std::size_t block) {
        const int left = int(block) % columns * noise_block, top = int(block) / columns * noise_block;
        const int right = std::min(left + noise_block, width), bottom = std::min(top + noise_block, height);
        if (!near_focus(left, top, right - 1, bottom - 1)) return;
        std::vector<double> details;
        for (int y = top; y < bottom; ++y)
            for (int x = left; x < right; ++x) {
                const std::size_t pixel = std::size_t(y) * std::size_t(width) + std::size_t(x);
                const SampleRange samples = ldi_.pixel(pixel);
                if (samples.empty() || !was_seen(pixel)) continue;
                const SurfaceNeighbours n = surface_neighbours(ldi_, lens_, samples.front(), x, y);
                if (n.horizontal > 0 && n.vertical > 0) details.push_back(detail(samples.front(), n));
            }
        if (details.empty()) return;
        const auto at =
            details.begin() + std::ptrdiff_t(double(details.size() - 1) * GatherTuning::noise_quantile);
        std::nth_element(details.begin(), at, details.end());
        noise_[block] = *at;
    });
}

Sharpener::Seen Sharpener::seen(const MergedSample &place, int x, int y) const {
    const Imath::V2d offset(double(place.dx), double(place.dy));
    const double coc = circle_of_confusion(lens_, double(place.image_z));
    if (!looks_) return {Imath::V2d(coc), offset};
    const Imath::V2d p = Imath::V2d(ldi_.windows.data.min + Imath::V2i(x, y)) + Imath::V2d(0.5) + offset;
    const double bent = looks_->field.bent(coc + looks_->coc, p);
    Imath::V2d along(bent);
    if (looks_->field.skews()) {
        const Imath::V2d s = looks_->field.skew(p);
        along = {std::hypot(bent + s.x, s.y), std::hypot(bent - s.x, s.y)};
    }
    if (!looks_->field.moves()) return {along, offset};
    const Imath::V2d at = looks_->field.shown_at(p);
    return {along, {at.x - std::floor(at.x) - 0.5, at.y - std::floor(at.y) - 0.5}};
}

// Sets `n` if a weight is above 0.
Sharpener::Weights Sharpener::weights(std::uint64_t i, int x, int y, SurfaceNeighbours &n) const {
    const Seen at = seen(sample_at(ldi_, i), x, y);
    Weights w{float(blur_.horizontal(at.coc.x, at.offset.x)),
              float(blur_.vertical(at.coc.y * lens_.pixel_aspect, at.offset.y)), 1};
    if (w.horizontal == 0 && w.vertical == 0) return {0, 0, 0};
    n = surface_neighbours(ldi_, lens_, i, x, y);
    w.horizontal *= n.horizontal;
    w.vertical *= n.vertical;
    const int columns = (ldi_.windows.width() + noise_block - 1) / noise_block;
    const double noise = GatherTuning::noise_times *
                         noise_[std::size_t(y / noise_block * columns + x / noise_block)],
                 d = detail(i, n);
    const double strength = noise > 0 ? (d > 0 ? 1 / (1 + std::pow(noise / d, 4)) : 0) : 1;
    w.horizontal *= float(strength);
    w.vertical *= float(strength);
    for (const std::size_t k : rgb_) {
        const std::vector<float> &v = ldi_.values[k];
        double given = 0; // the most that it gives to brighter neighbours, which must not exceed what it has
        for (std::size_t to = 0; to < 4; ++to)
            if (const double shown = n.along(to); shown > 0)
                given += 0.5 * shown * (w.along(to) + InterpolationBlur::largest_weight) *
                         std::max(0.0, double(v[n.sample[to]]) - double(v[i]));
        if (given > 0 && given * double(w.most) > double(v[i]))
            w.most = float(std::max(0.0, double(v[i])) / given);
    }
    return w;
}

template <typename Visit>
void Sharpener::for_each_near_focus(int top, int bottom, const Visit &visit) const {
    const int width = ldi_.windows.width();
    constexpr int size = BlockedSamples::size;
    for (int y = top; y < bottom; ++y)
        for (int left = 0; left < width; left += size) {
            if (!near_focus(left, y, left, y)) continue;
            for (int x = left; x < std::min(left + size, width); ++x)
                for (const std::uint64_t i : ldi_.pixel(std::size_t(y) * std::size_t(width) + std::size_t(x)))
                    visit(i, x, y);
        }
}

Sharpener::Band Sharpener::weigh(int top, int bottom) const {
    const std::size_t width = std::size_t(ldi_.windows.width());
    const int first = std::max(top - 1, 0), last = std::min(bottom + 1, ldi_.windows.height());
    const auto begin_of = [&](int row) { return ldi_.begin[std::size_t(row) * width]; };
    const std::size_t count = begin_of(last) - begin_of(first);
    Band band{begin_of(first), std::vector<Weights>(count), {}, std::vector<std::uint32_t>(count)};
    for_each_near_focus(first, last, [&](std::uint64_t i, int x, int y) {
        SurfaceNeighbours n;
        const Weights w = weights(i, x, y, n);
        band.weights[i - band.first] = w;
        if (w.most == 0) return;
        band.number[i - band.first] = std::uint32_t(band.neighbours.size());
        band.neighbours.push_back(n);
    });
    return band;
}

// The opposite of one of the four sides of SurfaceNeighbours.
constexpr std::size_t opposite(std::size_t side) { return side ^ 1; }

std::array<Term, 5> Sharpener::terms(const Band &band, std::uint64_t i) const {
    std::array<Term, 5> terms;
    terms.fill({i, 0});
    terms[0].coefficient = 1;
    const Weights &own = band.of(i);
    if (own.most == 0) return terms;
    const SurfaceNeighbours &n = band.beside(i);
    for (std::size_t k = 0; k < 4; ++k) {
        if (n.along(k) == 0) continue;
        const Weights &other = band.of(n.sample[k]);
        if (other.most == 0) continue;
        // The weight is the same for both, so that no light is made or lost. In front of a wall, the neighbour may have
        // a nearer neighbour itself.
        const SurfaceNeighbours &back = band.beside(n.sample[k]);
        if (back.sample[opposite(k)] != i) continue;
        const double shown = std::min(n.along(k), back.along(k));
        const double shared =
            0.5 * shown * (own.along(k) + other.along(k)) * double(std::min(own.most, other.most));
        terms[0].coefficient += shared;
        terms[k + 1] = {n.sample[k], -shared};
    }
    return terms;
}

} // namespace

void sharpen_near_focus(const Ldi &ldi, const ThinLens &lens, const BlockedSamples &samples,
                        SampleColours &colours, const SharpenLooks *looks) {
    Sharpener sharpener(ldi, lens, samples, looks);
    if (!sharpener.usable()) return;
    sharpener.measure_noise();
    constexpr int rows_at_once = 2 * BlockedSamples::size; // few, because weights take memory
    const std::size_t alpha = ldi.alpha();
    const int width = ldi.windows.width(), height = ldi.windows.height();
    parallel_for(std::size_t(pieces_of(height, rows_at_once)), [&](std::size_t number) {
        const int top = int(number) * rows_at_once, bottom = std::min(top + rows_at_once, height);
        if (!sharpener.near_focus(0, top, width - 1, bottom - 1)) return;
        const Sharpener::Band band = sharpener.weigh(top, bottom);
        const SamplePlaces places(samples, ldi, top, bottom);
        const auto sharpen = [&](std::uint64_t i, int, int) {
            const auto terms = sharpener.terms(band, i);
            if (terms[0].coefficient == 1) return;
            for (std::size_t k = 0; k < ldi.channels.size(); ++k) {
                if (k == alpha || !is_light(ldi.channels[k])) continue;
                double sum = 0;
                for (const Term &term : terms) sum += term.coefficient * double(ldi.values[k][term.index]);
                colours.at(k, places.of(i)) = float(sum);
            }
        };
        sharpener.for_each_near_focus(top, bottom, sharpen);
    });
}

} // namespace sparselens
