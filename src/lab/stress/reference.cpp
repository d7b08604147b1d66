#include "lab/stress/reference.h"

#include "base/parallel.h"

#include <algorithm>
#include <cmath>

namespace sparselens::lab::stress {

namespace {

struct Placed {
    long double x, y, coc, z, alpha;
    std::uint64_t source;
    bool background;
};

long double coc_at(const ThinLens &lens, long double z) {
    const long double rf = (long double)lens.radius * lens.focal_px, d = lens.focus;
    if (std::isinf(d)) return -rf / z;
    return std::isinf(z) ? rf / d : rf / d * ((z - d) / z);
}

// All samples and the backgrounds behind what is not opaque, front to back.
std::vector<Placed> place(const Ldi &ldi, const ThinLens &lens) {
    std::vector<Placed> placed;
    const Windows &w = ldi.windows;
    const std::size_t alpha = ldi.alpha();
    constexpr long double infinity = std::numeric_limits<long double>::infinity();
    for (std::size_t pixel = 0; pixel < w.pixels(); ++pixel) {
        const long double x = (long double)w.pixel(pixel).x + 0.5L, y = (long double)w.pixel(pixel).y + 0.5L;
        long double passed = 1;
        for (const std::uint64_t i : ldi.pixel(pixel)) {
            const long double a = alpha == npos ? 1.0L : (long double)ldi.values[alpha][i], z = ldi.z[i];
            const long double dx = ldi.dx.empty() ? 0 : ldi.dx[i], dy = ldi.dy.empty() ? 0 : ldi.dy[i];
            placed.push_back({x + dx, y + dy, coc_at(lens, z), z, a, i, false});
            passed *= 1 - a;
        }
        if (passed == 0) continue;
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

long double flattened(const Ldi &ldi, std::size_t pixel, std::size_t channel) {
    const std::size_t alpha = ldi.alpha();
    long double passed = 1, sum = 0;
    for (const std::uint64_t i : ldi.pixel(pixel)) {
        sum += passed * (long double)ldi.values[channel][i];
        passed *= 1 - (alpha == npos ? 1.0L : (long double)ldi.values[alpha][i]);
    }
    return sum;
}

} // namespace

LongPicture long_lens_picture(const Ldi &ldi, const ThinLens &lens, std::span<const LensSample> points) {
    const std::vector<Placed> samples = place(ldi, lens);
    const Windows &w = ldi.windows;
    const std::size_t pixels = w.pixels(), channels = ldi.channels.size();
    LongPicture picture{std::vector<long double>(channels * pixels), std::vector<bool>(pixels, true)};
    std::vector<char> sure(pixels, 1); // of its own: bits of a vector<bool> cannot be written by two threads
    parallel_for(pixels, [&](std::size_t pixel) {
        const long double x = (long double)w.pixel(pixel).x + 0.5L, y = (long double)w.pixel(pixel).y + 0.5L;
        std::vector<long double> sum(channels);
        long double weight = 0;
        for (const LensSample &point : points) {
            long double passed = 1;
            for (const Placed &s : samples) {
                const long double off_x =
                    std::abs(s.x + s.coc * (long double)point.x - (x - (long double)point.pixel_x));
                const long double off_y =
                    std::abs(s.y + s.coc * (long double)point.y - (y - (long double)point.pixel_y));
                const long double unclear = 2e-5L + 1e-6L * std::abs(s.coc);
                if (off_x > 0.5L + unclear || off_y > 0.5L + unclear) continue;
                if (off_x > 0.5L - unclear || off_y > 0.5L - unclear) sure[pixel] = 0;
                if (off_x >= 0.5L || off_y >= 0.5L) continue;
                for (std::size_t k = 0; k < channels && !s.background; ++k)
                    sum[k] += (long double)point.weight * passed * (long double)ldi.values[k][s.source];
                passed *= 1 - s.alpha;
                if (passed == 0) break;
            }
            weight += (long double)point.weight * (1 - passed);
        }
        for (std::size_t k = 0; k < channels; ++k)
            picture.values[k * pixels + pixel] = weight > 0 ? sum[k] / weight : flattened(ldi, pixel, k);
    });
    for (std::size_t i = 0; i < pixels; ++i) picture.sure[i] = sure[i] != 0;
    return picture;
}

} // namespace sparselens::lab::stress
