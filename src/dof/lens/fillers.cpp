#include "dof/lens/fillers.h"

#include "base/light.h"
#include "base/parallel.h"
#include "deep/build.h"
#include "deep/mixed_pixels.h"
#include "deep/unseen.h"
#include "dof/tuning.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace sparselens {

namespace {

constexpr float unknown = -1; // depth of a ground

// The last thing that a pixel holds.
struct Ground {
    float depth = unknown;                  // disparity, pixels
    std::uint32_t sample = Filler::nothing; // of the LDI
};

Ground ground_of(const Ldi &ldi, std::size_t alpha_channel, const ThinLens &lens, std::size_t pixel,
                 bool known) {
    const auto at_depth = [&](double z, std::uint32_t sample) {
        return Ground{float(disparity(lens, z)), sample};
    };
    std::uint32_t last = Filler::nothing;
    const double left = for_shares(ldi, alpha_channel, ldi.pixel(pixel), [&](std::uint64_t i, double) {
        if (alpha_at(ldi, alpha_channel, i) >= half_covered) last = std::uint32_t(i);
    });
    if (lets_through(left))
        return known ? at_depth(std::numeric_limits<double>::infinity(), Filler::nothing) : Ground{};
    return last == Filler::nothing ? Ground{} : at_depth(double(ldi.z[last]), last);
}

std::vector<Ground> find_grounds(const Ldi &ldi, const ThinLens &lens, const KnownPixels &known) {
    std::vector<Ground> grounds(ldi.windows.pixels());
    const std::size_t alpha = ldi.alpha();
    parallel_ranges(grounds.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t pixel = begin; pixel < end; ++pixel)
            grounds[pixel] = ground_of(ldi, alpha, lens, pixel, known.has(ldi.windows, pixel));
    });
    return grounds;
}

// Whether a ground continues n pixels beyond its end, where the ground is `other`.
bool goes_on(const Ground &ground, const Ground &other, int n) {
    if (other.depth == unknown) return false;
    const float nearer = other.depth - ground.depth;
    return nearer > one_surface_px && is_seen_behind(n, nearer);
}

// The pixels of a row or a column, from either end.
struct Line {
    std::ptrdiff_t first, step;
    int length;
    std::size_t pixel(int i) const { return std::size_t(first + i * step); }
};

constexpr std::size_t directions = 4; // in which grounds go on: right, left, down, up

Line line_of(const Windows &windows, std::size_t direction, std::size_t number) {
    const std::ptrdiff_t width = windows.width(), height = windows.height(), at = std::ptrdiff_t(number);
    switch (direction) {
    case 0: return {at * width, 1, int(width)};
    case 1: return {(at + 1) * width - 1, -1, int(width)};
    case 2: return {at, width, int(height)};
    default: return {(height - 1) * width + at, -width, int(height)};
    }
}

// For each pixel and direction: how far the pixel is from the end of the ground that continues there; 0: no ground
// does.
using Distances = std::vector<std::array<std::uint16_t, directions>>;

// Continues a ground of a line towards the line's end. It stops where it meets the continuation of another ground that
// is as deep or deeper: the other ground ends nearer to the pixel and continues as far.
void continue_ground(std::span<const Ground> grounds, const Line &line, int i, std::size_t direction,
                     Distances &distances) {
    const Ground &ground = grounds[line.pixel(i)];
    if (ground.depth == unknown) return;
    const int most = std::min(line.length - 1 - i, int(std::numeric_limits<std::uint16_t>::max()));
    for (int n = 1; n <= most; ++n) {
        const Ground &other = grounds[line.pixel(i + n)];
        if (!goes_on(ground, other, n)) break;
        std::uint16_t &distance = distances[line.pixel(i + n)][direction];
        if (distance == 0)
            distance = std::uint16_t(n);
        else if (grounds[line.pixel(i + n - distance)].depth <= ground.depth)
            break;
    }
}

Distances find_distances(std::span<const Ground> grounds, const Windows &windows) {
    Distances distances(grounds.size());
    for (std::size_t direction = 0; direction < directions; ++direction) {
        const int lines = direction < 2 ? windows.height() : windows.width();
        // Starts with the last grounds of a line, whose ends are nearest to where they continue. The grounds of
        // adjacent lines lie together in memory.
        parallel_ranges(std::size_t(lines), 16, [&](std::size_t begin, std::size_t end) {
            for (int i = line_of(windows, direction, begin).length - 2; i >= 0; --i)
                for (std::size_t number = begin; number < end; ++number)
                    continue_ground(grounds, line_of(windows, direction, number), i, direction, distances);
        });
    }
    return distances;
}

// The sample that a ground shows where it continues.
struct Shown {
    std::uint32_t sample; // of the LDI; or Filler::nothing
    std::size_t pixel;    // that has the sample
};

// Finds what grounds show where they continue. Where no view unmixed a silhouette, the last pixel of a ground shows a
// part of what hides the ground.
class ShownByGrounds {
public:
    ShownByGrounds(const Ldi &ldi, std::span<const Ground> grounds)
        : ldi_(ldi), grounds_(grounds), alpha_(ldi.alpha()), rgb_(find_rgb(ldi.channels)) {}

    // The Shown of the ground whose last pixel is `end`; `before` precedes it along a row or column, and `behind`,
    // which hides it, follows.
    Shown at_end(std::size_t end, std::size_t before, std::size_t behind) const {
        return is_mixed(end, before, behind) ? Shown{grounds_[before].sample, before}
                                             : Shown{grounds_[end].sample, end};
    }
    Shown at_end(std::size_t end) const { return {grounds_[end].sample, end}; }

private:
    bool is_mixed(std::size_t end, std::size_t before, std::size_t behind) const {
        if (ldi_.pixel(end).size() != 1 || std::ranges::find(rgb_, npos) != rgb_.end()) return false;
        for (const std::size_t pixel : {end, before, behind})
            if (grounds_[pixel].sample == Filler::nothing) return false;
        return is_one_surface(grounds_[before].depth, grounds_[end].depth) &&
               unmix(colour(end), colour(behind), colour(before), mostly_b, GatherTuning::filler_mixed)
                   .has_value();
    }
    Imath::V3d colour(std::size_t pixel) const {
        const std::uint32_t i = grounds_[pixel].sample;
        const auto value = [&](std::size_t k) { return double(ldi_.values[rgb_[k]][i]); };
        return Imath::V3d(value(0), value(1), value(2)) / double(alpha_at(ldi_, alpha_, i));
    }

    const Ldi &ldi_;
    std::span<const Ground> grounds_;
    std::size_t alpha_;
    std::array<std::size_t, 3> rgb_;
};

// A side from which a ground continues.
struct Side {
    Ground ground;
    Shown shown;
    int distance;
    auto order() const { return std::tuple(distance, ground.depth, ground.sample == Filler::nothing); }
};

// Whether the pixel holds a sample of the surface that the ground belongs to.
bool is_seen(const Ldi &ldi, const ThinLens &lens, std::size_t pixel, const Ground &ground) {
    if (ground.sample == Filler::nothing) return false;
    for (const std::uint64_t i : ldi.pixel(pixel)) {
        const auto depth = float(disparity(lens, double(ldi.z[i])));
        if (is_one_surface(depth, ground.depth)) return true;
    }
    return false;
}

Filler mean_of(const Ldi &ldi, std::size_t alpha_channel, std::size_t pixel, const Side &nearest,
               std::span<const Side> sides) {
    const bool nothing = nearest.ground.sample == Filler::nothing;
    Filler filler{std::uint32_t(pixel), std::numeric_limits<float>::infinity(), 0, {}};
    if (!nothing) filler.z = ldi.z[nearest.ground.sample];
    float sum = 0;
    for (const auto &[ground, shown, distance] : sides) {
        if ((ground.sample == Filler::nothing) != nothing) continue;
        if (!is_one_surface(ground.depth, nearest.ground.depth)) continue;
        const float weight = 1 / float(distance);
        const float coverage = nothing ? 1 : alpha_at(ldi, alpha_channel, shown.sample);
        filler.part[filler.count++] = {shown.sample, std::uint32_t(shown.pixel), weight / coverage};
        sum += weight;
    }
    for (Filler::Part &part : filler.part) part.share /= sum;
    return filler;
}

} // namespace

LargeArray<Filler> find_fillers(const Ldi &ldi, const ThinLens &lens, const KnownPixels &known) {
    const std::vector<Ground> grounds = find_grounds(ldi, lens, known);
    const Distances distances = find_distances(grounds, ldi.windows);
    const std::size_t alpha = ldi.alpha();
    const std::size_t width = std::size_t(ldi.windows.width());
    const std::array<std::size_t, directions> step{1, 0 - std::size_t{1}, width, 0 - width};
    const ShownByGrounds shown(ldi, grounds);
    std::vector<std::vector<Filler>> rows(std::size_t(ldi.windows.height()));
    parallel_for(rows.size(), [&](std::size_t row) {
        for (std::size_t pixel = row * width; pixel < (row + 1) * width; ++pixel) {
            std::array<Side, directions> sides;
            std::size_t count = 0;
            for (std::size_t k = 0; k < directions; ++k)
                if (const int n = distances[pixel][k]; n > 0) {
                    const std::size_t end = pixel - std::size_t(n) * step[k], before = end - step[k];
                    const bool has_before = before < grounds.size() && (k > 1 || before / width == row);
                    sides[count++] = {
                        grounds[end],
                        has_before ? shown.at_end(end, before, end + step[k]) : shown.at_end(end), n};
                }
            if (count == 0) continue;
            const std::span<const Side> found = std::span(sides).first(count);
            const Side &nearest = *std::ranges::min_element(found, {}, &Side::order);
            if (!is_seen(ldi, lens, pixel, nearest.ground))
                rows[row].push_back(mean_of(ldi, alpha, pixel, nearest, found));
        }
    });
    std::vector<std::size_t> begin{0};
    for (const std::vector<Filler> &row : rows) begin.push_back(begin.back() + row.size());
    LargeArray<Filler> fillers(begin.back());
    parallel_for(rows.size(), [&](std::size_t row) {
        std::ranges::copy(std::exchange(rows[row], {}), fillers.begin() + std::ptrdiff_t(begin[row]));
    });
    return fillers;
}

namespace {

PlacedSample placed(const ThinLens &lens, const Filler &filler, int x, int y, std::uint32_t source) {
    return {float(x) + 0.5f,
            float(y) + 0.5f,
            float(circle_of_confusion(lens, double(filler.z))),
            float(disparity(lens, double(filler.z))),
            1,
            source};
}

// Finds the filler of a pixel.
class FillersByPixel {
public:
    FillersByPixel(std::span<const Filler> fillers, const Windows &windows)
        : fillers_(fillers), width_(std::size_t(windows.width())),
          begin_((windows.pixels() + pixels_at_once - 1) / pixels_at_once + 1, fillers.size()) {
        for (std::size_t f = fillers.size(); f-- > 0;) begin_[fillers[f].pixel / pixels_at_once] = f;
        for (std::size_t i = begin_.size() - 1; i-- > 0;) begin_[i] = std::min(begin_[i], begin_[i + 1]);
    }
    const Filler *at(int x, int y) const {
        const std::size_t pixel = std::size_t(y) * width_ + std::size_t(x);
        for (std::size_t f = begin_[pixel / pixels_at_once]; f < fillers_.size(); ++f)
            if (fillers_[f].pixel >= pixel) return fillers_[f].pixel == pixel ? &fillers_[f] : nullptr;
        return nullptr;
    }

private:
    static constexpr std::size_t pixels_at_once = 8;
    std::span<const Filler> fillers_;
    std::size_t width_;
    std::vector<std::size_t> begin_; // of each `pixels_at_once` consecutive pixels; and the end
};

// Whether a sample of a pixel is one surface with samples of most pixels in the square of three by three around it.
bool is_wide(const Ldi &ldi, const ThinLens &lens, std::size_t pixel, std::uint64_t sample) {
    const auto depth = [&](std::uint64_t i) { return disparity(lens, double(ldi.z[i])); };
    const auto shows_it = [&](std::size_t p) {
        for (const std::uint64_t i : ldi.pixel(p))
            if (is_one_surface(depth(i), depth(sample))) return true;
        return false;
    };
    const Imath::V2i at = ldi.windows.pixel(pixel);
    int all = 0, same = 0;
    for (int y = at.y - 1; y <= at.y + 1; ++y)
        for (int x = at.x - 1; x <= at.x + 1; ++x) {
            if (!ldi.windows.data.intersects(Imath::V2i(x, y))) continue;
            ++all;
            same += shows_it(ldi.windows.index(x, y));
        }
    return 2 * same > all;
}

} // namespace

FillerSamples place_fillers(const Ldi &ldi, const ThinLens &lens, std::span<const Filler> fillers,
                            const BlockedSamples &samples, const SampleColours &colours) {
    if (fillers.empty()) return {};
    const FillersByPixel by_pixel(fillers, ldi.windows);
    const auto is_there = [&](int x, int y) {
        return by_pixel.at(x, y) ? SampleCounts{1, 1} : SampleCounts{};
    };
    const auto place = [&](int x, int y, std::vector<PlacedSample> &found) {
        if (const Filler *f = by_pixel.at(x, y))
            found.push_back(
                placed(lens, *f, x, y,
                       f->is_nothing() ? BlockedSamples::background : std::uint32_t(f - fillers.data())));
    };
    FillerSamples result{make_blocks(ldi.windows, is_there, place), {}};
    const std::size_t count = result.samples.count();
    result.colours = {colours.groups, count, LargeArray<float>(colours.groups * count * 4, 0.0f)};
    parallel_ranges(count, 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (result.samples.source[i] == BlockedSamples::background) continue;
            for (const Filler::Part &part : fillers[result.samples.source[i]].parts()) {
                const std::uint32_t from = place_of(samples, ldi, part.pixel, part.sample);
                for (std::size_t k = 0; k < ldi.channels.size(); ++k)
                    result.colours.at(k, i) += part.share * colours.at(k, from);
            }
        }
    });
    return result;
}

BlockedSamples place_hiding_fillers(const Ldi &ldi, const ThinLens &lens, std::span<const Filler> fillers,
                                    const BlockedSamples &samples,
                                    std::span<const std::uint32_t> highlights) {
    std::vector<char> hides(fillers.size());
    parallel_ranges(fillers.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t f = begin; f < end; ++f)
            hides[f] = !fillers[f].is_nothing() &&
                       std::ranges::any_of(fillers[f].parts(), [&](const Filler::Part &part) {
                           return is_wide(ldi, lens, part.pixel, part.sample) &&
                                  !std::ranges::binary_search(
                                      highlights, place_of(samples, ldi, part.pixel, part.sample));
                       });
    });
    if (std::ranges::find(hides, true) == hides.end()) return {};
    const FillersByPixel by_pixel(fillers, ldi.windows);
    const auto hiding_at = [&](int x, int y) {
        const Filler *f = by_pixel.at(x, y);
        return f && hides[std::size_t(f - fillers.data())] ? f : nullptr;
    };
    const auto is_there = [&](int x, int y) { return hiding_at(x, y) ? SampleCounts{1, 1} : SampleCounts{}; };
    const auto place = [&](int x, int y, std::vector<PlacedSample> &found) {
        if (const Filler *f = hiding_at(x, y))
            found.push_back(placed(lens, *f, x, y, std::uint32_t(f - fillers.data())));
    };
    BlockedSamples hiding = make_blocks(ldi.windows, is_there, place);
    hiding.named.resize(hiding.count());
    parallel_ranges(hiding.count(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n) {
            const Filler &filler = fillers[hiding.source[n]];
            hiding.source[n] = std::uint32_t(ldi.pixel(filler.pixel).front());
            hiding.named[n] = place_of(samples, ldi, filler.part[0].pixel, filler.part[0].sample);
        }
    });
    return hiding;
}

} // namespace sparselens
