#include "base/matte.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <map>
#include <string_view>
#include <utility>

namespace sparselens {

namespace {

constexpr std::size_t few = 16;  // ids that are searched one by one
constexpr double nothing = 1e-6; // what rounding leaves when a coverage is taken away

std::uint32_t bits(float id) { return std::bit_cast<std::uint32_t>(id); }

struct Place {
    int rank;
    Matte::Rank channels;
};

} // namespace

std::vector<Matte> find_mattes(std::span<const Channel> channels) {
    std::map<std::pair<std::string_view, int>, std::size_t> coverages; // by matte and rank, the first of each
    for (std::size_t k = 0; k < channels.size(); ++k)
        if (channels[k].kind == ChannelKind::matte_coverage)
            coverages.try_emplace({channels[k].matte, channels[k].rank}, k);
    std::vector<Matte> mattes;
    std::map<std::string_view, std::size_t> numbers;
    std::vector<std::vector<Place>> places; // of each matte
    for (std::size_t k = 0; k < channels.size(); ++k) {
        if (channels[k].kind != ChannelKind::matte_id) continue;
        const auto coverage = coverages.find({channels[k].matte, channels[k].rank});
        if (coverage == coverages.end()) continue;
        const auto [number, is_new] = numbers.try_emplace(channels[k].matte, mattes.size());
        if (is_new) {
            mattes.push_back({channels[k].matte, {}});
            places.emplace_back();
        }
        places[number->second].push_back({channels[k].rank, {k, coverage->second}});
    }
    for (std::size_t m = 0; m < mattes.size(); ++m) {
        std::ranges::sort(places[m], {}, &Place::rank);
        for (const Place &place : places[m]) mattes[m].ranks.push_back(place.channels);
    }
    return mattes;
}

void IdCoverage::add(float id, double coverage) {
    if (coverage == 0) return;
    if (pairs_.size() <= few) {
        const auto same =
            std::ranges::find_if(pairs_, [id](const Pair &pair) { return bits(pair.id) == bits(id); });
        if (same != pairs_.end()) {
            same->coverage += coverage;
            return;
        }
    } else if (pairs_.size() >= 2 * merged_) {
        merge();
    }
    pairs_.push_back({id, coverage});
}

// Adds the coverages of one id in the order in which they came, as add() does for few ids.
void IdCoverage::merge() {
    std::ranges::stable_sort(pairs_, {}, [](const Pair &pair) { return bits(pair.id); });
    std::size_t last = 0;
    for (std::size_t i = 1; i < pairs_.size(); ++i)
        if (bits(pairs_[i].id) == bits(pairs_[last].id))
            pairs_[last].coverage += pairs_[i].coverage;
        else
            pairs_[++last] = pairs_[i];
    pairs_.resize(last + 1);
    merged_ = pairs_.size();
}

void IdCoverage::limit() {
    double sum = 0, positive = 0;
    for (const Pair &pair : pairs_) {
        sum += pair.coverage;
        positive += std::max(pair.coverage, 0.0);
    }
    const double limited = std::clamp(sum, 0.0, 1.0);
    for (Pair &pair : pairs_) pair.coverage = std::max(pair.coverage, 0.0);
    if (positive == limited) return;
    for (Pair &pair : pairs_) pair.coverage *= limited / positive;
}

std::span<const IdCoverage::Pair> IdCoverage::ranked() {
    if (pairs_.size() > few) merge();
    std::erase_if(pairs_, [](const Pair &pair) { return !(pair.coverage > nothing); });
    std::ranges::sort(pairs_, [](const Pair &a, const Pair &b) {
        return a.coverage != b.coverage ? a.coverage > b.coverage : bits(a.id) < bits(b.id);
    });
    return pairs_;
}

} // namespace sparselens
