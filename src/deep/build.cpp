#include "deep/build.h"

#include "base/matte.h"
#include "base/parallel.h"

#include <algorithm>

namespace sparselens {

namespace {
// Of the last sample of `out`.
void unite_mattes(Ldi &out, const Ldi &from, std::span<const Term> terms) {
    const std::vector<Matte> mattes = find_mattes(from.channels);
    MatteSum sum(mattes);
    for (const Term &term : terms)
        sum.add(term.coefficient, [&](std::size_t k) { return from.values[k][term.index]; });
    sum.take([&](std::size_t k, float value) { out.values[k].back() = value; });
}
} // namespace

MergedSample sample_at(const Ldi &ldi, std::uint64_t i) {
    const auto or_else = [i](const std::vector<float> &values, float absent) {
        return values.empty() ? absent : values[i];
    };
    return {ldi.z[i], back_at(ldi, i), or_else(ldi.dx, 0), or_else(ldi.dy, 0), or_else(ldi.weight, 1), {}};
}

void append(Ldi &out, const Ldi &from, const MergedSample &sample) {
    out.z.push_back(sample.z);
    if (!from.z_back.empty()) out.z_back.push_back(sample.z_back);
    if (!from.dx.empty()) out.dx.push_back(sample.dx);
    if (!from.dy.empty()) out.dy.push_back(sample.dy);
    if (!from.weight.empty()) out.weight.push_back(sample.weight);
    const bool unchanged = sample.terms.size() == 1 && sample.terms[0].coefficient == 1;
    bool mattes = false;
    for (std::size_t k = 0; k < from.values.size(); ++k) {
        const bool copied = holds_ids(from.channels[k]) || unchanged;
        mattes = mattes || (is_in_matte(from.channels[k]) && !unchanged);
        double sum = 0; // many small coefficients: float would lose the small ones
        if (!copied)
            for (const Term &term : sample.terms) sum += term.coefficient * from.values[k][term.index];
        out.values[k].push_back(copied ? from.values[k][sample.terms[0].index] : float(sum));
    }
    if (mattes) unite_mattes(out, from, sample.terms);
    ++out.begin.back();
}

void append(Ldi &out, const Ldi &from, std::uint64_t index) {
    const Term whole{index, 1};
    MergedSample sample = sample_at(from, index);
    sample.terms = {&whole, 1};
    append(out, from, sample);
}

Ldi without_channels(const Ldi &ldi) {
    return {ldi.windows, {}, ldi.begin, ldi.z, ldi.z_back, ldi.dx, ldi.dy, ldi.weight, {}};
}

Ldi empty_like(const Ldi &like) {
    Ldi ldi;
    ldi.windows = like.windows;
    ldi.channels = like.channels;
    ldi.values.resize(like.channels.size());
    return ldi;
}

Ldi build_by_pixels(const Ldi &like, const std::function<void(std::size_t, Ldi &)> &fill) {
    const Grid grid(like.windows.width(), like.windows.height());
    std::vector<Ldi> rows(std::size_t(grid.height()));
    parallel_for(rows.size(), [&](std::size_t y) {
        Ldi &piece = rows[y] = empty_like(like);
        piece.begin.reserve(std::size_t(grid.width()) + 1);
        piece.begin.push_back(0);
        for (int x = 0; x < grid.width(); ++x) {
            piece.begin.push_back(piece.begin.back());
            fill(grid.index(x, int(y)), piece);
        }
    });
    return concatenate(like, rows);
}

Ldi concatenate(const Ldi &like, std::span<const Ldi> pieces) {
    Ldi whole = empty_like(like);
    std::vector<std::uint64_t> first_sample(pieces.size() + 1, 0), first_pixel(pieces.size() + 1, 0);
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        first_sample[i + 1] = first_sample[i] + pieces[i].samples();
        first_pixel[i + 1] = first_pixel[i] + pieces[i].begin.size() - 1;
    }
    const auto gather = [&](std::vector<float> &to, const auto &array_of) {
        if (std::all_of(pieces.begin(), pieces.end(), [&](const Ldi &p) { return array_of(p).empty(); }))
            return;
        to.resize(first_sample.back());
        parallel_for(pieces.size(), [&](std::size_t i) {
            const std::vector<float> &from = array_of(pieces[i]);
            std::copy(from.begin(), from.end(), to.begin() + std::ptrdiff_t(first_sample[i]));
        });
    };
    gather(
        whole.z, [](const Ldi &p) -> const auto & { return p.z; });
    gather(
        whole.z_back, [](const Ldi &p) -> const auto & { return p.z_back; });
    gather(
        whole.dx, [](const Ldi &p) -> const auto & { return p.dx; });
    gather(
        whole.dy, [](const Ldi &p) -> const auto & { return p.dy; });
    gather(
        whole.weight, [](const Ldi &p) -> const auto & { return p.weight; });
    for (std::size_t k = 0; k < whole.values.size(); ++k)
        gather(
            whole.values[k], [k](const Ldi &p) -> const auto & { return p.values[k]; });
    whole.begin.resize(first_pixel.back() + 1);
    parallel_for(pieces.size(), [&](std::size_t i) {
        for (std::size_t j = 0; j + 1 < pieces[i].begin.size(); ++j)
            whole.begin[first_pixel[i] + j] = first_sample[i] + pieces[i].begin[j];
    });
    whole.begin.back() = first_sample.back();
    return whole;
}

} // namespace sparselens
