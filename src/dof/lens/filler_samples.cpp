#include "dof/lens/filler_samples.h"

#include "base/parallel.h"

#include <algorithm>

namespace sparselens {

namespace {

PlacedSample placed(const ThinLens &lens, const Filler &filler, int x, int y, std::uint32_t number) {
    return {float(x) + 0.5f,
            float(y) + 0.5f,
            float(circle_of_confusion(lens, double(filler.z))),
            float(perceptive_depth(lens, double(filler.z))),
            1,
            filler.is_nothing() ? BlockedSamples::background : number};
}

// Where the fillers of each row of pixels begin; and the end.
std::vector<std::size_t> rows_of(std::span<const Filler> fillers, const Windows &windows) {
    const std::size_t width = std::size_t(windows.width());
    std::vector<std::size_t> rows(std::size_t(windows.height()) + 1, fillers.size());
    for (std::size_t f = fillers.size(); f-- > 0;) rows[fillers[f].pixel / width] = f;
    for (std::size_t row = rows.size() - 1; row-- > 0;) rows[row] = std::min(rows[row], rows[row + 1]);
    return rows;
}

} // namespace

FillerSamples place_fillers(const Ldi &ldi, const ThinLens &lens, std::span<const Filler> fillers,
                            const BlockedSamples &samples, const SampleColours &colours) {
    if (fillers.empty()) return {};
    const std::vector<std::size_t> rows = rows_of(fillers, ldi.windows);
    const auto filler_of = [&](int x, int y) -> const Filler * {
        const auto row =
            fillers.subspan(rows[std::size_t(y)], rows[std::size_t(y) + 1] - rows[std::size_t(y)]);
        const auto pixel = std::uint32_t(y * ldi.windows.width() + x);
        const auto f = std::ranges::lower_bound(row, pixel, {}, &Filler::pixel);
        return f != row.end() && f->pixel == pixel ? &*f : nullptr;
    };
    const auto is_there = [&](int x, int y) { return filler_of(x, y) ? SampleCounts{1, 1} : SampleCounts{}; };
    const auto place = [&](int x, int y, std::vector<PlacedSample> &found) {
        if (const Filler *f = filler_of(x, y))
            found.push_back(placed(lens, *f, x, y, std::uint32_t(f - fillers.data())));
    };
    FillerSamples result{make_blocks(ldi.windows, is_there, place), {}};
    const std::size_t count = result.samples.count();
    result.colours = {colours.groups, count, std::vector<float>(colours.groups * count * 4)};
    parallel_ranges(count, 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (result.samples.source[i] == BlockedSamples::background) continue;
            for (const Filler::Part &part : fillers[result.samples.source[i]].parts()) {
                const std::uint32_t from = place_of(samples, ldi, part.sample);
                for (std::size_t k = 0; k < ldi.channels.size(); ++k)
                    result.colours.at(k, i) += part.share * colours.at(k, from);
            }
        }
    });
    return result;
}

} // namespace sparselens
