#include "warp/matting/matte_shares.h"

#include <algorithm>
#include <bit>
#include <numeric>

namespace sparselens {

namespace {

using Pair = IdCoverage::Pair;

bool same_id(float a, float b) { return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b); }

// The coverage of an object in a sample of the view.
double coverage_in(const ViewSamples &view, const Matte &matte, float id, std::uint64_t sample) {
    double sum = 0;
    for (const Matte::Rank &rank : matte.ranks)
        if (same_id(view.value(rank.id, sample), id)) sum += double(view.value(rank.coverage, sample));
    return sum;
}

// The coverage without an object of the matte.
double none_in(const ViewSamples &view, const Matte &matte, std::uint64_t sample) {
    double left = double(alpha_at(view, view.alpha(), sample));
    for (const Matte::Rank &rank : matte.ranks) left -= double(view.value(rank.coverage, sample));
    return left;
}

// The objects of a sample, each once.
std::vector<Pair> objects_in(const ViewSamples &view, const Matte &matte, std::uint64_t sample) {
    IdCoverage objects;
    for (const Matte::Rank &rank : matte.ranks)
        objects.add(view.value(rank.id, sample), double(view.value(rank.coverage, sample)));
    const std::span<const Pair> ranked = objects.ranked();
    return {ranked.begin(), ranked.end()};
}

double sum_of(const std::vector<double> &values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

// Returns `guess`, changed so that it is at least 0, at most `all`, and `share` in total.
std::vector<double> shared_out(std::vector<double> guess, const std::vector<double> &all, double share) {
    for (std::size_t i = 0; i < all.size(); ++i) guess[i] = std::clamp(guess[i], 0.0, all[i]);
    const double sum = sum_of(guess), left = sum_of(all) - sum;
    for (std::size_t i = 0; i < all.size(); ++i)
        if (sum > share)
            guess[i] *= share / sum;
        else if (left > 0)
            guess[i] += (all[i] - guess[i]) * std::min((share - sum) / left, 1.0);
    return guess;
}

} // namespace

void share_mattes(const ViewSamples &view, std::uint64_t sample, std::span<const Term> front, double share,
                  std::span<const Matte> mattes, Ldi &out) {
    for (const Matte &matte : mattes) {
        const std::vector<Pair> objects = objects_in(view, matte, sample);
        std::vector<double> all, guess; // of each object, and of no object
        const auto add = [&](double coverage, const auto &coverage_of_term) {
            all.push_back(coverage);
            guess.push_back(0);
            for (const Term &term : front) guess.back() += term.coefficient * coverage_of_term(term.index);
        };
        for (const Pair &object : objects)
            add(object.coverage, [&](std::uint64_t i) { return coverage_in(view, matte, object.id, i); });
        add(std::max(none_in(view, matte, sample), 0.0),
            [&](std::uint64_t i) { return none_in(view, matte, i); });
        const std::vector<double> in_front = shared_out(guess, all, share);
        IdCoverage nearer, farther;
        for (std::size_t n = 0; n < objects.size(); ++n) {
            nearer.add(objects[n].id, in_front[n]);
            farther.add(objects[n].id, (all[n] - in_front[n]) / (1 - share));
        }
        const auto write = [&](IdCoverage &pairs, std::size_t before_last) {
            write_pairs(matte, pairs.ranked(), [&](std::size_t k, float value) {
                std::vector<float> &values = out.values[k];
                values[values.size() - 1 - before_last] = value;
            });
        };
        write(nearer, 1);
        write(farther, 0);
    }
}

} // namespace sparselens
