#include "deep/holdout.h"

#include "base/matte.h"
#include "base/parallel.h"
#include "deep/build.h"
#include "deep/channel_alpha.h"
#include "deep/flatten.h"
#include "kernels/holdout_rules.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

Holdout::Holdout(Ldi ldi) : ldi_(std::move(ldi)), alpha_(ldi_.alpha()) {}

double Holdout::passes(int x, int y, double z) const {
    if (!ldi_.windows.data.intersects(Imath::V2i(x, y))) return 1;
    const std::size_t pixel = ldi_.windows.index(x, y);
    double passed = 1;
    for (const std::uint64_t i : ldi_.pixel(pixel)) {
        if (!(passed > 0)) break;
        const double front = ldi_.z[i], back = back_at(ldi_, i);
        if (!kernels::is_held_out(front, z)) break;
        const double clear = std::max(0.0, 1 - double(alpha_at(ldi_, alpha_, i)));
        passed *= kernels::passes_part(front, back, clear, z);
    }
    return passed;
}

void Holdout::append_parts(int x, int y, std::vector<Part> &parts) const {
    if (!ldi_.windows.data.intersects(Imath::V2i(x, y))) return;
    for (const std::uint64_t i : ldi_.pixel(ldi_.windows.index(x, y)))
        parts.push_back(
            {ldi_.z[i], float(back_at(ldi_, i)), std::max(0.0f, 1 - float(alpha_at(ldi_, alpha_, i)))});
}

std::size_t Holdout::parts_in(const Imath::Box2i &pixels) const {
    const Imath::Box2i &data = ldi_.windows.data;
    const int left = std::max(pixels.min.x, data.min.x), right = std::min(pixels.max.x, data.max.x);
    std::size_t count = 0;
    for (int y = std::max(pixels.min.y, data.min.y); left <= right && y <= std::min(pixels.max.y, data.max.y);
         ++y)
        count += ldi_.begin[ldi_.windows.index(right, y) + 1] - ldi_.begin[ldi_.windows.index(left, y)];
    return count;
}

namespace {

Image flatten_by_alpha(const Ldi &ldi, const Holdout &holdout) {
    Image out = flatten(ldi); // provides the ids
    const Imath::Box2i &data = ldi.windows.data;
    const std::size_t alpha = ldi.alpha();
    const std::vector<Matte> mattes = find_mattes(ldi.channels);
    parallel_for(std::size_t(ldi.windows.height()), [&](std::size_t row) {
        std::vector<double> sums(ldi.channels.size());
        MatteSum matte_sums(mattes);
        const int y = data.min.y + int(row);
        for (int x = data.min.x; x <= data.max.x; ++x) {
            const std::size_t pixel = ldi.windows.index(x, y);
            std::ranges::fill(sums, 0.0);
            double transmittance = 1;
            for (const std::uint64_t i : ldi.pixel(pixel)) {
                if (!(transmittance > 0)) break;
                const double share = transmittance * holdout.passes(x, y, ldi.z[i]);
                for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += share * ldi.values[k][i];
                matte_sums.add(share, [&](std::size_t k) { return ldi.values[k][i]; });
                transmittance *= 1 - double(alpha_at(ldi, alpha, i));
            }
            for (std::size_t k = 0; k < sums.size(); ++k)
                if (!holds_ids(ldi.channels[k]))
                    out.values[k * out.windows.pixels() + pixel] = float(sums[k]);
            matte_sums.take(
                [&](std::size_t k, float value) { out.values[k * out.windows.pixels() + pixel] = value; });
        }
    });
    return out;
}

} // namespace

Image flatten_held_out(const Ldi &ldi, const Holdout &holdout) {
    return composited(ldi, [&](const Ldi &one) { return flatten_by_alpha(one, holdout); });
}

} // namespace sparselens
