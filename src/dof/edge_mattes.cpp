#include "dof/edge_mattes.h"

#include "base/parallel.h"
#include "deep/mixed_pixels.h"
#include "dof/tuning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace sparselens {

namespace {

constexpr int reach = GatherTuning::matte_reach_px;

// A pixel near a jump.
struct Matte {
    float share;     // a; 0 and 1: one sample
    float near, far; // disparities, pixels
    std::array<float, 3> behind;
};

class Mattes {
public:
    Mattes(const Ldi &ldi, const std::array<std::size_t, 3> &rgb, const ThinLens &lens)
        : ldi_(ldi), rgb_(rgb), grid_(ldi.windows.grid().array()), disparities_(grid_.size()),
          least_(grid_.size()), most_(grid_.size()) {
        for (std::size_t i = 0; i < disparities_.size(); ++i)
            disparities_[i] = float(disparity(lens, double(ldi.z[i])));
        parallel_for(std::size_t(grid_.height()), [&](std::size_t y) { find_extremes(int(y)); });
    }

    std::optional<Matte> at(const Position &at) const {
        const std::size_t own = grid_.index(at);
        if (!(most_[own] - least_[own] >= GatherTuning::matte_same * GatherTuning::matte_least_px)) return {};
        float least = least_[own], most = most_[own]; // of all pixels that surface() asks
        for (int k = 0; k < 9; ++k) {
            const Position there = at + Imath::V2i(k % 3 - 1, k / 3 - 1) * (reach + 1);
            if (!grid_.contains(there)) continue;
            least = std::min(least, least_[grid_.index(there)]);
            most = std::max(most, most_[grid_.index(there)]);
        }
        const float step = most - least;
        if (!(step >= GatherTuning::matte_least_px) || !std::isfinite(step)) return {};
        const auto all = [](std::size_t) { return true; };
        const float little = GatherTuning::matte_same * step;
        const auto is_flat = [&](std::size_t i) { return most_[i] - least_[i] <= little; };
        const auto behind = surface(at, least, little, is_flat);
        if (!behind) return {};
        auto front = surface(at, most, little, is_flat);
        if (!front) front = surface(at, most, little, all);
        else
            return matte_of(own, *front, *behind);
        if (!front) return {};
        // It is thin, so that only what differs most from what is behind is its own colour.
        const Imath::V3d away = front->colour - behind->colour;
        front = surface(at, most, little,
                        [&](std::size_t i) { return (colour(i) - front->colour).dot(away) >= 0; });
        if (!front) return {};
        const Imath::V3d c = colour(own), f = front->colour, b = behind->colour;
        const double along = (c - b).dot(f - b) / (f - b).length2();
        Matte matte{along > 0.5 ? 1.0f : 0.0f,
                    front->disparity,
                    behind->disparity,
                    {float(b.x), float(b.y), float(b.z)}};
        if (along < GatherTuning::matte_least_share || along > 1 - GatherTuning::matte_least_share) {
            const Imath::V3d off = c - (along > 0.5 ? f : b);
            if (!(off.length() < GatherTuning::matte_residual * (f - b).length())) return {};
            return matte;
        }
        const auto mix = unmix(c, f, b, no_prior, GatherTuning::matte_residual);
        if (!mix) return {};
        matte.share = float(mix->share);
        return matte;
    }

private:
    struct Surface {
        Imath::V3d colour;
        float disparity;
    };

    Imath::V3d colour(std::size_t i) const {
        return {double(ldi_.values[rgb_[0]][i]), double(ldi_.values[rgb_[1]][i]), double(ldi_.values[rgb_[2]][i])};
    }

    void find_extremes(int y) {
        const int width = grid_.width();
        std::vector<float> low(std::size_t(width), std::numeric_limits<float>::infinity()),
            high(std::size_t(width), -std::numeric_limits<float>::infinity());
        for (int v = std::max(y - reach, 0); v <= std::min(y + reach, grid_.height() - 1); ++v)
            for (int x = 0; x < width; ++x) {
                const float d = disparities_[grid_.index(Position(x, v))];
                low[std::size_t(x)] = std::min(low[std::size_t(x)], d);
                high[std::size_t(x)] = std::max(high[std::size_t(x)], d);
            }
        for (int x = 0; x < width; ++x) {
            const auto first = std::ptrdiff_t(std::max(x - reach, 0)),
                       end = std::ptrdiff_t(std::min(x + reach + 1, width));
            const std::size_t i = grid_.index(Position(x, y));
            least_[i] = *std::min_element(low.begin() + first, low.begin() + end);
            most_[i] = *std::max_element(high.begin() + first, high.begin() + end);
        }
    }

    // The mean of the pixels around that have about this disparity and no jump near them.
    std::optional<Surface> surface(const Position &at, float disparity, float little, const auto &counts) const {
        constexpr int far = 2 * reach + 1;
        std::array<double, 4> sum{};
        double weights = 0;
        for (int y = std::max(at.row - far, 0); y <= std::min(at.row + far, grid_.height() - 1); ++y)
            for (int x = std::max(at.column - far, 0); x <= std::min(at.column + far, grid_.width() - 1);
                 ++x) {
                const std::size_t i = grid_.index(Position(x, y));
                if (std::abs(disparities_[i] - disparity) > little || !counts(i)) continue;
                const int dx = x - at.column, dy = y - at.row;
                const double weight = 1.0 / (1 + dx * dx + dy * dy);
                for (std::size_t k = 0; k < 3; ++k) sum[k] += weight * double(ldi_.values[rgb_[k]][i]);
                sum[3] += weight * double(disparities_[i]);
                weights += weight;
            }
        if (!(weights > 0)) return {};
        return Surface{{sum[0] / weights, sum[1] / weights, sum[2] / weights}, float(sum[3] / weights)};
    }

    const Ldi &ldi_;
    const std::array<std::size_t, 3> &rgb_;
    ArrayGrid grid_;
    std::vector<float> disparities_, least_, most_; // the last two: of the pixels within `reach`
};

} // namespace

Ldi matte_edges(Ldi photograph, const ThinLens &lens) {
    const std::array rgb = find_rgb(photograph.channels);
    if (!all_found(rgb) || photograph.alpha() != npos || photograph.channels.size() != 3 ||
        photograph.samples() != photograph.windows.pixels())
        return photograph;
    std::vector<std::vector<std::pair<std::size_t, Matte>>> rows(std::size_t(photograph.windows.height()));
    {
        const Mattes mattes(photograph, rgb, lens);
        parallel_for(rows.size(), [&](std::size_t y) {
            for (int x = 0; x < photograph.windows.width(); ++x)
                if (const auto matte = mattes.at(Position(x, int(y))))
                    rows[y].emplace_back(photograph.windows.index(Position(x, int(y))), *matte);
        });
    }
    Ldi result;
    result.windows = photograph.windows;
    result.channels = photograph.channels;
    result.channels.push_back({"A", photograph.channels[0].type});
    result.values.resize(4);
    const double scale = disparity_scale(lens.radius, lens.focal_px);
    const auto add = [&](float z, const std::array<float, 4> &values) {
        result.z.push_back(z);
        for (std::size_t k = 0; k < 4; ++k) result.values[k < 3 ? rgb[k] : 3].push_back(values[k]);
    };
    result.begin = {0};
    std::size_t i = 0;
    for (const auto &row : rows) {
        auto next = row.begin();
        const std::size_t end = i + std::size_t(photograph.windows.width());
        for (; i < end; ++i, result.begin.push_back(result.z.size())) {
            std::array<float, 4> c{0, 0, 0, 1};
            for (std::size_t k = 0; k < 3; ++k) c[k] = photograph.values[rgb[k]][i];
            if (next == row.end() || next->first != i) {
                add(photograph.z[i], c);
                continue;
            }
            const Matte &matte = next++->second;
            const float near = float(depth_at_disparity(scale, double(matte.near))),
                        far = float(depth_at_disparity(scale, double(matte.far)));
            if (matte.share == 0 || matte.share == 1) {
                add(matte.share == 1 ? near : far, c);
                continue;
            }
            std::array<float, 4> front{0, 0, 0, matte.share};
            for (std::size_t k = 0; k < 3; ++k) front[k] = c[k] - (1 - matte.share) * matte.behind[k];
            add(near, front);
            add(far, {matte.behind[0], matte.behind[1], matte.behind[2], 1});
        }
    }
    return result;
}

} // namespace sparselens
