#include "dof/lens/filler_samples.h"

#include "base/parallel.h"
#include "kernels/surface.h"

#include <algorithm>

namespace sparselens {

namespace {

PlacedSample placed(const ThinLens &lens, const Filler &filler, int x, int y, std::uint32_t source) {
    return {float(x) + 0.5f,
            float(y) + 0.5f,
            float(circle_of_confusion(lens, double(filler.z))),
            float(perceptive_depth(lens, double(filler.z))),
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
    const auto depth = [&](std::uint64_t i) { return perceptive_depth(lens, double(ldi.z[i])); };
    const auto shows_it = [&](std::size_t p) {
        for (const std::uint64_t i : ldi.pixel(p))
            if (kernels::is_one_surface<double>(depth(i), depth(sample), one_surface_px)) return true;
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
            found.push_back(placed(lens, *f, x, y, std::uint32_t(ldi.pixel(f->pixel).front())));
    };
    return make_blocks(ldi.windows, is_there, place);
}

} // namespace sparselens
