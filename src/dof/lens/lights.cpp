#include "dof/lens/lights.h"

#include "kernels/lens_rules.h"

#include <algorithm>

namespace sparselens {

using namespace tile_cells;

namespace {

void add(double *to, Float4 values) {
    for (std::size_t k = 0; k < 4; ++k) to[k] += double(values[k]);
}

} // namespace

std::vector<float> EvenLight::known(std::size_t groups) const {
    std::vector<float> known;
    known.reserve(groups * pixels * 4);
    for (std::size_t g = 0; g < groups; ++g)
        for (const float unknown : unknown_)
            known.insert(known.end(), 4, kernels::known_weight(total_ - unknown, total_));
    return known;
}

template <std::size_t sides_>
ChannelLight<sides_>::ChannelLight(const GatherScene &scene)
    : scene_(scene), steps_(scene.colours.groups * size * (size + 1) * 4),
      lost_(scene.colours.groups * pixels * 4), in_front_(sides > 1 ? lost_.size() : 0) {
    for (auto *of : {&light_, &weight_})
        for (auto &channels : *of) channels.resize(scene.colours.groups * 4);
}

template <std::size_t sides_>
void ChannelLight<sides_>::count(const LensSample &point, const Seen &seen) {
    total_ += point.weight;
    weigh_channels(point);
    double *row = steps_.data();
    for (std::size_t g = 0; g < scene_.colours.groups; ++g) {
        const Float4 weight = load4(&weight_[0][g * 4]);
        for (const CatEye::Columns &columns : seen.columns) {
            if (columns.begin < columns.end) {
                add(row + columns.begin * 4, weight);
                add(row + columns.end * 4, -weight);
            }
            row += (size + 1) * 4;
        }
    }
}

template <std::size_t sides_>
void ChannelLight<sides_>::weigh_channels(const LensSample &point) {
    for (std::size_t k = 0; k < light_[0].size(); ++k) {
        const ColourSet set = scene_.colours.sets[k];
        const bool darkened = kernels::is_darkened(set, scene_.cat_eye() && scene_.cat_eye()->darkens());
        for (const std::size_t side : {0u, 1u}) {
            const ColourFactors &rgb = point.rgb, &of_side = side == 1 ? point.in_front : point.behind;
            light_[side][k] = kernels::light_weight(
                set, point.weight, kernels::of_colour(set, rgb[0], rgb[1], rgb[2], 1),
                kernels::of_colour(set, of_side[0], of_side[1], of_side[2], of_side[1]));
            weight_[side][k] = darkened ? point.weight : light_[side][k];
        }
    }
}

template <std::size_t sides_>
void ChannelLight<sides_>::lose(std::size_t pixel, float share) {
    for (std::size_t g = 0; g < scene_.colours.groups; ++g)
        add(&lost_[(g * pixels + pixel) * 4], share * load4(&weight_[0][g * 4]));
}

template <std::size_t sides_>
void ChannelLight<sides_>::put_in_front(std::size_t pixel, float share) {
    if constexpr (sides > 1)
        for (std::size_t g = 0; g < scene_.colours.groups; ++g) {
            float *more = &in_front_[(g * pixels + pixel) * 4];
            store4(more, load4(more) + share * (load4(&weight_[1][g * 4]) - load4(&weight_[0][g * 4])));
        }
}

template <std::size_t sides_>
std::vector<float> ChannelLight<sides_>::known(std::size_t groups) const {
    std::vector<float> known(groups * pixels * 4);
    const double *step = steps_.data();
    for (std::size_t row = 0, at = 0; row < groups * size; ++row, step += 4) {
        std::array<double, 4> sum{};
        for (std::size_t n = 0; n < size * 4; ++n, ++at)
            known[at] = kernels::known_weight(
                float((sum[n % 4] += *step++) - lost_[at] + (sides > 1 ? double(in_front_[at]) : 0)), total_);
    }
    return known;
}

template class ChannelLight<1>;
template class ChannelLight<2>;

} // namespace sparselens
