// Cryptomatte: which objects a pixel or a sample shows, as pairs of an id and its coverage ("Cryptomatte
// specification", J. Friedman, A. Jones, 2015). An id is the hash of a name, whose 32 bits stand in a float channel; R
// and G of the layer NAME00 are the pair of rank 0, B and A that of rank 1, R and G of NAME01 that of rank 2, and so
// on, by descending coverage. The attributes cryptomatte/... of the header say which NAMEs there are.
//
// Ids are only copied. The coverage of one id behaves as premultiplied colour does: where samples are averaged or
// composited, the coverage of each id is, and the pairs are ranked anew.
#pragma once

#include "image.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace sparselens {

struct Matte {
    struct Rank {
        std::size_t id, coverage; // channels
    };
    std::string name;
    std::vector<Rank> ranks; // by descending coverage; only ranks with both channels
};

// The mattes among the channels, by their kinds (channel_kind.h).
std::vector<Matte> find_mattes(std::span<const Channel> channels);

// Coverage by id.
class IdCoverage {
public:
    struct Pair {
        float id; // compared by its bits
        double coverage;
    };

    void add(float id, double coverage);
    // Sets negative coverage to 0, and scales the rest so that the sum stays the same, clamped to [0, 1].
    void limit();
    std::span<const Pair> ranked(); // by descending coverage, without pairs that cover nothing
    void clear() { pairs_.clear(), merged_ = 0; }

private:
    void merge();

    std::vector<Pair> pairs_; // if few, one per id; if many, pairs added after merge() follow at the end
    std::size_t merged_ = 0;
};

// Calls write(k, value) for every channel of the matte. Pairs beyond its last rank are dropped.
template <typename Write>
void write_pairs(const Matte &matte, std::span<const IdCoverage::Pair> ranked, const Write &write) {
    for (std::size_t r = 0; r < matte.ranks.size(); ++r) {
        const IdCoverage::Pair pair = r < ranked.size() ? ranked[r] : IdCoverage::Pair{0, 0};
        write(matte.ranks[r].id, pair.id);
        write(matte.ranks[r].coverage, float(pair.coverage));
    }
}

// A weighted sum of the pairs of samples.
class MatteSum {
public:
    explicit MatteSum(std::span<const Matte> mattes) : mattes_(mattes), sums_(mattes.size()) {}

    // `value(k)` returns the value of the sample in channel k.
    template <typename Value>
    void add(double factor, const Value &value) {
        for (std::size_t m = 0; m < mattes_.size(); ++m)
            for (const Matte::Rank &rank : mattes_[m].ranks)
                sums_[m].add(value(rank.id), factor * double(value(rank.coverage)));
    }

    // Calls write(k, value) for every channel of every matte, as write_pairs() does, and empties the sum.
    template <typename Write>
    void take(const Write &write) {
        for (std::size_t m = 0; m < mattes_.size(); ++m) {
            write_pairs(mattes_[m], sums_[m].ranked(), write);
            sums_[m].clear();
        }
    }

private:
    std::span<const Matte> mattes_;
    std::vector<IdCoverage> sums_; // of each matte
};

} // namespace sparselens
