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
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

namespace sparselens {

namespace {

constexpr float unknown = -1; // depth of a ground

// The last thing that a pixel holds.
struct Ground {
    float depth = unknown;                  // disparity, pixels
    std::uint32_t sample = Filler::nothing; // of the LDI
    bool is_nothing() const { return sample == Filler::nothing; }
};

// Whether a ground continues n pixels beyond its end, where the ground is `other`.
bool goes_on(const Ground &ground, const Ground &other, int n) {
    if (other.depth == unknown) return false;
    const float nearer = other.depth - ground.depth;
    return nearer > one_surface_px && is_seen_behind(n, nearer);
}

// A side from which a ground continues.
struct Side {
    Ground ground;
    std::size_t shown; // the pixel whose ground it shows
    int distance;
    std::size_t direction;
    auto order() const { return std::tuple(distance, ground.depth, ground.is_nothing()); }
};

class FillerSearch {
public:
    FillerSearch(const Ldi &ldi, const ThinLens &lens, const KnownPixels &known)
        : ldi_(ldi), lens_(lens), alpha_(ldi.alpha()), rgb_(find_rgb(ldi.channels)),
          width_(std::size_t(ldi.windows.width())), grounds_(ldi.windows.pixels()), nearest_(grounds_.size()),
          farthest_(grounds_.size()) {
        parallel_ranges(grounds_.size(), 4096, [&](std::size_t begin, std::size_t end) {
            for (std::size_t pixel = begin; pixel < end; ++pixel)
                grounds_[pixel] = ground_of(pixel, known.has(ldi.windows, pixel));
        });
        for (std::size_t k = 0; k < directions; ++k) continue_grounds(k);
    }
    // Adds the fillers of a pixel: of the grounds with the nearest ends, and of the farthest ones behind.
    void find(std::size_t pixel, std::vector<Filler> &fillers) const {
        float before = std::numeric_limits<float>::infinity();
        for (const auto *ends : {&nearest_, &farthest_}) {
            std::array<Side, directions> all;
            const std::span<const Side> sides = sides_behind(before, pixel, (*ends)[pixel], all);
            if (sides.empty()) return;
            const Side &first = *std::ranges::min_element(sides, {}, &Side::order);
            if (!is_seen(pixel, first.ground)) fillers.push_back(mean_of(pixel, first, sides));
            before = first.ground.depth;
        }
    }

private:
    static constexpr std::size_t directions = 4; // in which grounds go on: right, left, down, up
    // For each direction: how far a pixel is from the end of a ground that continues there; 0: no ground does.
    using Distances = std::array<std::uint16_t, directions>;

    // The sides whose ground lies behind a depth, on another surface.
    std::span<const Side> sides_behind(float depth, std::size_t pixel, const Distances &distances,
                                       std::array<Side, directions> &sides) const {
        std::size_t count = 0;
        for (std::size_t k = 0; k < directions; ++k) {
            const std::size_t end = pixel - distances[k] * step(k);
            if (distances[k] > 0 && depth - grounds_[end].depth > one_surface_px)
                sides[count++] = {grounds_[end], is_mixed(end, k) ? end - step(k) : end, distances[k], k};
        }
        return std::span(sides).first(count);
    }

    // From pixel to pixel in a direction.
    std::size_t step(std::size_t direction) const {
        return (direction < 2 ? 1 : width_) * (direction % 2 == 0 ? 1 : ~std::size_t{0});
    }
    Ground ground_of(std::size_t pixel, bool known) const {
        std::uint32_t last = Filler::nothing;
        const double left = for_shares(ldi_, alpha_, ldi_.pixel(pixel), [&](std::uint64_t i, double) {
            if (alpha_at(ldi_, alpha_, i) >= half_covered) last = std::uint32_t(i);
        });
        if (lets_through(left)) return {known ? 0 : unknown, Filler::nothing};
        return last == Filler::nothing ? Ground{} : Ground{depth_of(last), last};
    }
    // Starts with the last grounds of a line, whose ends are nearest to where they continue. The grounds of adjacent
    // lines lie together in memory.
    void continue_grounds(std::size_t direction) {
        const bool along_rows = direction < 2;
        const std::size_t length = along_rows ? width_ : grounds_.size() / width_;
        const auto pixel = [&](std::size_t line, std::size_t i) { // the i-th from the line's end
            const std::size_t at = direction % 2 == 0 ? length - 1 - i : i;
            return along_rows ? line * width_ + at : at * width_ + line;
        };
        parallel_ranges(grounds_.size() / length, 16, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = 1; i < length; ++i)
                for (std::size_t line = begin; line < end; ++line)
                    continue_ground(pixel(line, i), direction, int(i));
        });
    }
    // Continues a ground by at most `most` pixels. It stops where it meets the continuation of another ground that is
    // as deep or deeper: the other ground ends nearer to the pixel and continues as far.
    void continue_ground(std::size_t end, std::size_t direction, int most) {
        const Ground &ground = grounds_[end];
        if (ground.depth == unknown) return;
        std::size_t pixel = end;
        for (int n = 1; n <= std::min(most, int(std::numeric_limits<std::uint16_t>::max())); ++n) {
            pixel += step(direction);
            if (!goes_on(ground, grounds_[pixel], n)) break;
            const auto depth = [&](int distance) {
                return grounds_[pixel - std::size_t(distance) * step(direction)].depth;
            };
            std::uint16_t &nearest = nearest_[pixel][direction], &farthest = farthest_[pixel][direction];
            if (nearest > 0 && depth(nearest) <= ground.depth) break;
            if (nearest == 0) nearest = std::uint16_t(n);
            if (farthest == 0 || depth(farthest) > ground.depth) farthest = std::uint16_t(n);
        }
    }
    // Whether the last pixel of a ground shows a part of what hides it: no view unmixed the silhouette.
    bool is_mixed(std::size_t end, std::size_t direction) const {
        const std::size_t before = end - step(direction), behind = end + step(direction);
        if (before >= grounds_.size() || (direction < 2 && before / width_ != end / width_)) return false;
        if (ldi_.pixel(end).size() != 1 || !all_found(rgb_)) return false;
        for (const std::size_t pixel : {end, before, behind})
            if (grounds_[pixel].is_nothing()) return false;
        return is_one_surface(grounds_[before].depth, grounds_[end].depth) &&
               unmix(colour(end), colour(behind), colour(before), mostly_b, GatherTuning::filler_mixed)
                   .has_value();
    }
    Imath::V3d colour(std::size_t pixel) const {
        const std::uint32_t i = grounds_[pixel].sample;
        const auto value = [&](std::size_t k) { return double(ldi_.values[rgb_[k]][i]); };
        return Imath::V3d(value(0), value(1), value(2)) / double(alpha_at(ldi_, alpha_, i));
    }
    float depth_of(std::uint64_t sample) const { return float(disparity(lens_, double(ldi_.z[sample]))); }
    // Whether the pixel holds a sample of the surface that the ground belongs to.
    bool is_seen(std::size_t pixel, const Ground &ground) const {
        if (ground.is_nothing()) return false;
        for (const std::uint64_t i : ldi_.pixel(pixel))
            if (is_one_surface(depth_of(i), ground.depth)) return true;
        return false;
    }
    Filler mean_of(std::size_t pixel, const Side &nearest, std::span<const Side> all) const {
        const bool nothing = nearest.ground.is_nothing();
        Filler filler{std::uint32_t(pixel), std::numeric_limits<float>::infinity(), 0, {}, false};
        if (!nothing) filler.z = ldi_.z[nearest.ground.sample];
        float sum = 0;
        std::array<bool, directions> ends{};
        for (const auto &[ground, shown, distance, direction] : all) {
            if (ground.is_nothing() != nothing) continue;
            if (!is_one_surface(ground.depth, nearest.ground.depth)) continue;
            const std::uint32_t sample = grounds_[shown].sample;
            const float weight = 1 / float(distance), coverage = nothing ? 1 : alpha_at(ldi_, alpha_, sample);
            filler.part[filler.count++] = {sample, std::uint32_t(shown), weight / coverage};
            sum += weight;
            ends[direction] = true;
        }
        filler.is_between = !nothing && ((ends[0] && ends[1]) || (ends[2] && ends[3]));
        for (Filler::Part &part : filler.part) part.share /= sum;
        return filler;
    }

    const Ldi &ldi_;
    const ThinLens &lens_;
    std::size_t alpha_;
    std::array<std::size_t, 3> rgb_;
    std::size_t width_;
    std::vector<Ground> grounds_; // [pixel]
    // [pixel]: to the nearest end, and to that of the farthest ground.
    std::vector<Distances> nearest_, farthest_;
};

} // namespace

LargeArray<Filler> find_fillers(const Ldi &ldi, const ThinLens &lens, const KnownPixels &known) {
    const FillerSearch search(ldi, lens, known);
    const auto width = std::size_t(ldi.windows.width());
    std::vector<std::vector<Filler>> rows(std::size_t(ldi.windows.height()));
    parallel_for(rows.size(), [&](std::size_t row) {
        for (std::size_t pixel = row * width; pixel < (row + 1) * width; ++pixel)
            search.find(pixel, rows[row]);
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

PlacedSample filler_at(const ThinLens &lens, const Position &at, const Filler &filler, std::uint32_t source) {
    const double z = double(filler.z);
    return {float(at.column) + 0.5f,
            float(at.row) + 0.5f,
            float(circle_of_confusion(lens, z)),
            float(disparity(lens, z)),
            1,
            source};
}

// The fillers of each pixel.
class FillersOfPixels {
public:
    FillersOfPixels(const Ldi &ldi, std::span<const Filler> fillers)
        : fillers_(fillers), begin_(ldi.windows.pixels() + 1) {
        for (const Filler &filler : fillers) ++begin_[filler.pixel + 1];
        std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    }
    std::span<const Filler> at(std::size_t pixel) const {
        return fillers_.subspan(begin_[pixel], begin_[pixel + 1] - begin_[pixel]);
    }

private:
    std::span<const Filler> fillers_;
    std::vector<std::uint32_t> begin_; // [pixel], and the end
};

// Places the fillers for which is_placed(number) is true; `source` is the number.
template <typename IsPlaced>
BlockedSamples placed(const Ldi &ldi, const ThinLens &lens, std::span<const Filler> fillers,
                      const FillersOfPixels &of_pixels, const IsPlaced &is_placed) {
    return make_blocks(ldi.windows, [&](const Position &at, std::vector<PlacedSample> &found) {
        for (const Filler &filler : of_pixels.at(ldi.windows.index(at))) {
            const auto f = std::uint32_t(&filler - fillers.data());
            if (is_placed(f))
                found.push_back(
                    filler_at(lens, at, filler, filler.is_nothing() ? BlockedSamples::background : f));
        }
    });
}

// Calls visit(pixel) for the pixels in the square of three by three around one.
template <typename Visit>
void for_each_around(const Ldi &ldi, std::size_t pixel, const Visit &visit) {
    const Imath::V2i at = ldi.windows.pixel(pixel);
    for (int y = at.y - 1; y <= at.y + 1; ++y)
        for (int x = at.x - 1; x <= at.x + 1; ++x)
            if (ldi.windows.data.intersects(Imath::V2i(x, y))) visit(ldi.windows.index(Imath::V2i(x, y)));
}

// Whether a sample of a pixel is one surface with samples of most pixels around it.
bool is_wide(const Ldi &ldi, const ThinLens &lens, std::size_t pixel, std::uint64_t sample) {
    const auto depth = [&](std::uint64_t i) { return disparity(lens, double(ldi.z[i])); };
    int all = 0, same = 0;
    for_each_around(ldi, pixel, [&](std::size_t beside) {
        bool shows_it = false;
        for (const std::uint64_t i : ldi.pixel(beside))
            shows_it = shows_it || is_one_surface(depth(i), depth(sample));
        ++all;
        same += shows_it;
    });
    return 2 * same > all;
}

} // namespace

FillerSamples place_fillers(const Ldi &ldi, const ThinLens &lens, std::span<const Filler> fillers,
                            const BlockedSamples &samples, const SampleColours &colours,
                            const std::optional<std::span<const std::uint32_t>> &highlights) {
    if (fillers.empty()) return {};
    const FillersOfPixels of_pixels(ldi, fillers);
    FillerSamples result{placed(ldi, lens, fillers, of_pixels, [](std::uint32_t) { return true; }), {}, {}};
    const std::size_t count = result.samples.count();
    result.colours = {colours.groups, count, LargeArray<float>(colours.groups * count * 4, 0.0f)};
    const auto place = [&](const Filler::Part &part) {
        return place_of(samples, ldi, part.pixel, part.sample);
    };
    parallel_ranges(count, 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (result.samples.source[i] == BlockedSamples::background) continue;
            for (const Filler::Part &part : fillers[result.samples.source[i]].parts()) {
                const std::uint32_t from = place(part);
                for (std::size_t k = 0; k < ldi.channels.size(); ++k)
                    result.colours.at(k, i) += part.share * colours.at(k, from);
            }
        }
    });
    if (!highlights) return result;
    std::vector<char> hides(fillers.size());
    parallel_ranges(fillers.size(), 4096, [&](std::size_t begin, std::size_t end) {
        const auto hides_lamps = [&](const Filler::Part &part) {
            return is_wide(ldi, lens, part.pixel, part.sample) &&
                   !std::ranges::binary_search(*highlights, place(part));
        };
        for (std::size_t f = begin; f < end; ++f)
            hides[f] = !fillers[f].is_nothing() && std::ranges::any_of(fillers[f].parts(), hides_lamps);
    });
    BlockedSamples &hiding = result.hiding =
        placed(ldi, lens, fillers, of_pixels, [&](std::uint32_t f) { return hides[f]; });
    hiding.named.resize(hiding.count());
    parallel_ranges(hiding.count(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n) {
            const Filler &filler = fillers[hiding.source[n]];
            hiding.source[n] = std::uint32_t(ldi.pixel(filler.pixel).front());
            hiding.named[n] = place(filler.part[0]);
        }
    });
    return result;
}

BlockedSamples place_solids(const Ldi &ldi, const ThinLens &lens, std::span<const Filler> fillers,
                            const BlockedSamples &samples) {
    if (ldi.solid.empty() && std::ranges::none_of(fillers, &Filler::is_between)) return {};
    const FillersOfPixels of_pixels(ldi, fillers);
    const std::size_t alpha = ldi.alpha();
    const auto hides = [&](std::uint64_t i) { return is_opaque(alpha_at(ldi, alpha, i)); };
    const auto may_show = [&](std::uint64_t i) { return hides(i) && ldi.coc_z(i) == double(ldi.z[i]); };
    // The one of `samples` that the solid of a sample shows.
    const auto shown_by = [&](std::size_t pixel, std::uint64_t i) -> std::optional<std::uint32_t> {
        if (may_show(i)) return place_of(samples, ldi, pixel, i);
        std::optional<std::uint32_t> nearest;
        double least = hides(i) ? 0 : std::numeric_limits<double>::infinity();
        for_each_around(ldi, pixel, [&](std::size_t beside) {
            for (const std::uint64_t n : ldi.pixel(beside)) {
                const double behind = 1 / double(ldi.z[i]) - 1 / double(ldi.z[n]);
                if (!may_show(n) || behind > double(ldi.solid[i]) || std::abs(behind) >= least) continue;
                nearest = place_of(samples, ldi, beside, n);
                least = std::abs(behind);
            }
        });
        return nearest;
    };
    const auto place = [&](const Position &at, std::vector<PlacedSample> &placed) {
        const std::size_t pixel = ldi.windows.index(at);
        for (const Filler &filler : of_pixels.at(pixel)) {
            const Filler::Part &shown = filler.part[0];
            if (!filler.is_between || !may_show(shown.sample) ||
                !is_wide(ldi, lens, shown.pixel, shown.sample))
                continue;
            PlacedSample &solid =
                placed.emplace_back(filler_at(lens, at, filler, std::uint32_t(ldi.pixel(pixel).front())));
            solid.depth = std::max(solid.depth - one_surface_px, 0.0f);
            solid.named = place_of(samples, ldi, shown.pixel, shown.sample);
        }
        for (const std::uint64_t i : ldi.pixel(pixel)) {
            if (ldi.solid.empty() || !(ldi.solid[i] > 0)) continue;
            const MergedSample s = sample_at(ldi, i);
            const double back = 1 / double(s.z) - double(s.solid),
                         hidden = 1 / double(s.z) - 2 * double(s.solid);
            if (!(hidden > 0)) continue;
            if (const auto shown = shown_by(pixel, i))
                placed.push_back({float(at.column) + 0.5f + s.dx,
                                  float(at.row) + 0.5f + s.dy,
                                  float(circle_of_confusion(lens, 1 / back)),
                                  float(disparity(lens, 1 / hidden)),
                                  1,
                                  std::uint32_t(i),
                                  {},
                                  *shown});
        }
    };
    return make_blocks(ldi.windows, place, Also::names);
}

} // namespace sparselens
