#include "base/matte.h"

#include <algorithm>
#include <bit>
#include <cstdint>

namespace sparselens {

namespace {

constexpr double nothing = 1e-6; // what rounding leaves of a coverage that was taken away

std::uint32_t bits(float id) { return std::bit_cast<std::uint32_t>(id); }

struct Place {
    int rank;
    Matte::Rank channels;
};

} // namespace

std::vector<Matte> find_mattes(std::span<const Channel> channels) {
    std::vector<Matte> mattes;
    std::vector<std::vector<Place>> places; // of each matte
    for (std::size_t k = 0; k < channels.size(); ++k) {
        if (channels[k].kind != ChannelKind::matte_id) continue;
        const auto coverage = std::ranges::find_if(channels, [&](const Channel &c) {
            return c.kind == ChannelKind::matte_coverage && c.rank == channels[k].rank &&
                   c.matte == channels[k].matte;
        });
        if (coverage == channels.end()) continue;
        auto found = std::ranges::find(mattes, channels[k].matte, &Matte::name);
        if (found == mattes.end()) {
            mattes.push_back({channels[k].matte, {}});
            places.emplace_back();
            found = mattes.end() - 1;
        }
        places[std::size_t(found - mattes.begin())].push_back(
            {channels[k].rank, {k, std::size_t(coverage - channels.begin())}});
    }
    for (std::size_t m = 0; m < mattes.size(); ++m) {
        std::ranges::sort(places[m], {}, &Place::rank);
        for (const Place &place : places[m]) mattes[m].ranks.push_back(place.channels);
    }
    return mattes;
}

void IdCoverage::add(float id, double coverage) {
    if (coverage == 0) return;
    const auto same =
        std::ranges::find_if(pairs_, [id](const Pair &pair) { return bits(pair.id) == bits(id); });
    if (same == pairs_.end())
        pairs_.push_back({id, coverage});
    else
        same->coverage += coverage;
}

std::span<const IdCoverage::Pair> IdCoverage::ranked() {
    std::erase_if(pairs_, [](const Pair &pair) { return !(pair.coverage > nothing); });
    std::ranges::sort(pairs_, [](const Pair &a, const Pair &b) {
        return a.coverage != b.coverage ? a.coverage > b.coverage : bits(a.id) < bits(b.id);
    });
    return pairs_;
}

} // namespace sparselens
