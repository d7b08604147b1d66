#include "deep/build.h"

#include "base/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace sparselens {

MergedSample sample_at(const Ldi &ldi, std::uint64_t i) {
    const auto or_else = [i](const std::vector<float> &values, float absent) {
        return values.empty() ? absent : values[i];
    };
    return {ldi.z[i],
            back_at(ldi, i),
            or_else(ldi.dx, 0),
            or_else(ldi.dy, 0),
            or_else(ldi.weight, 1),
            float(ldi.coc_z(i)),
            or_else(ldi.solid, 0),
            {}};
}

void append(Ldi &out, const Ldi &from, const MergedSample &sample) {
    append(out, from, sample, [&](std::size_t k, std::uint64_t i) { return from.values[k][i]; });
}

void append(Ldi &out, const Ldi &from, std::uint64_t index) {
    const Term whole{index, 1};
    MergedSample sample = sample_at(from, index);
    sample.terms = {&whole, 1};
    append(out, from, sample);
}

float solid_of(const Ldi &ldi, std::size_t alpha_channel, std::span<const Term> terms) {
    if (ldi.solid.empty()) return 0;
    float least = std::numeric_limits<float>::infinity();
    for (const Term &term : terms)
        if (alpha_at(ldi, alpha_channel, term.index) >= half_covered)
            least = std::min(least, ldi.solid[term.index]);
    return std::isinf(least) ? 0 : least;
}

Ldi without_channels(const Ldi &ldi) {
    return {ldi.windows, {},         ldi.begin,   ldi.z,     ldi.z_back, ldi.dx,
            ldi.dy,      ldi.weight, ldi.image_z, ldi.solid, {}};
}

Ldi empty_like(const Ldi &like) {
    Ldi ldi;
    ldi.windows = like.windows;
    ldi.channels = like.channels;
    ldi.values.resize(like.channels.size());
    return ldi;
}

Ldi build_by_pixels(const Ldi &like, const std::function<void(std::size_t, Ldi &)> &fill) {
    const ArrayGrid grid(like.windows.width(), like.windows.height());
    std::vector<Ldi> rows(std::size_t(grid.height()));
    parallel_for(rows.size(), [&](std::size_t y) {
        Ldi &piece = rows[y] = empty_like(like);
        piece.begin.reserve(std::size_t(grid.width()) + 1);
        piece.begin.push_back(0);
        for (int x = 0; x < grid.width(); ++x) {
            piece.begin.push_back(piece.begin.back());
            fill(grid.index(Position(x, int(y))), piece);
        }
    });
    return concatenate(like, std::move(rows));
}

namespace {

// The new samples of a row of pixels, for the pixels that change.
struct ChangedRow {
    Ldi samples;
    std::vector<bool> changes; // [pixel]
};

ChangedRow changed_row(const Ldi &ldi, std::size_t first, std::size_t width,
                       const std::function<bool(std::size_t)> &changes,
                       const std::function<void(std::size_t, Ldi &)> &fill) {
    ChangedRow row{empty_like(ldi), std::vector<bool>(width)};
    row.samples.begin.assign(1, 0);
    for (std::size_t x = 0; x < width; ++x) {
        row.samples.begin.push_back(row.samples.begin.back());
        row.changes[x] = changes(first + x);
        if (row.changes[x]) fill(first + x, row.samples);
    }
    return row;
}

// Samples to be copied to another place, from a row, or from the LDI itself if `from_row` is null.
struct Move {
    const Ldi *from_row;
    std::uint64_t from, count, to;
};

// Lists the moves of a row that begins at pixel `first`, and sets where its pixels begin.
void list_moves(const Ldi &ldi, const ChangedRow &row, std::size_t first, std::vector<std::uint64_t> &begin,
                std::vector<Move> &moves) {
    for (std::size_t x = 0; x < row.changes.size(); ++x) {
        const Ldi *source = row.changes[x] ? &row.samples : nullptr;
        const SampleRange samples = source ? source->pixel(x) : ldi.pixel(first + x);
        const std::uint64_t to = begin[first + x];
        begin[first + x + 1] = to + samples.size();
        Move *last = moves.empty() ? nullptr : &moves.back();
        if (last && last->from_row == source && last->from + last->count == samples.from)
            last->count += samples.size();
        else
            moves.push_back({source, samples.from, samples.size(), to});
    }
}

constexpr std::size_t arrays_beside_values = 7;

template <typename Source> // Ldi or const Ldi
auto &array_of(Source &ldi, std::size_t k) {
    switch (k) {
    case 0: return ldi.z;
    case 1: return ldi.z_back;
    case 2: return ldi.dx;
    case 3: return ldi.dy;
    case 4: return ldi.weight;
    case 5: return ldi.image_z;
    case 6: return ldi.solid;
    default: return ldi.values[k - arrays_beside_values];
    }
}

void make_moves(std::vector<float> &array, std::size_t k, const std::vector<Move> &moves) {
    for (const Move &move : moves) {
        const std::vector<float> &source = move.from_row ? array_of(*move.from_row, k) : array;
        if (!move.from_row && move.from == move.to) continue;
        const auto from = source.begin() + std::ptrdiff_t(move.from);
        std::copy(from, from + std::ptrdiff_t(move.count), array.begin() + std::ptrdiff_t(move.to));
    }
}

} // namespace

void rebuild_pixels(Ldi &ldi, const std::function<bool(std::size_t)> &changes,
                    const std::function<void(std::size_t, Ldi &)> &fill) {
    constexpr std::size_t rows_at_once = 64;
    const ArrayGrid grid(ldi.windows.width(), ldi.windows.height());
    const auto width = std::size_t(grid.width()), height = std::size_t(grid.height());
    std::vector<std::uint64_t> begin(ldi.begin.size(), 0);
    const std::size_t arrays = arrays_beside_values + ldi.values.size();
    for (std::size_t top = 0; top < height; top += rows_at_once) {
        std::vector<ChangedRow> rows(std::min(rows_at_once, height - top));
        parallel_for(rows.size(), [&](std::size_t r) {
            rows[r] = changed_row(ldi, (top + r) * width, width, changes, fill);
        });
        std::vector<Move> moves;
        for (std::size_t r = 0; r < rows.size(); ++r)
            list_moves(ldi, rows[r], (top + r) * width, begin, moves);
        parallel_for(arrays, [&](std::size_t k) {
            if (!array_of(ldi, k).empty()) make_moves(array_of(ldi, k), k, moves);
        });
    }
    for (std::size_t k = 0; k < arrays; ++k)
        if (!array_of(ldi, k).empty()) array_of(ldi, k).resize(begin.back());
    ldi.begin = std::move(begin);
}

Ldi concatenate(const Ldi &like, std::vector<Ldi> pieces) {
    Ldi whole = empty_like(like);
    std::vector<std::uint64_t> first_sample(pieces.size() + 1, 0);
    std::size_t pixels = 0;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        first_sample[i + 1] = first_sample[i] + pieces[i].samples();
        pixels += pieces[i].begin.size() - 1;
    }
    for (std::size_t k = 0; k < arrays_beside_values + like.channels.size(); ++k) {
        if (std::ranges::all_of(pieces, [k](const Ldi &piece) { return array_of(piece, k).empty(); }))
            continue;
        std::vector<float> &to = array_of(whole, k);
        to.resize(first_sample.back());
        parallel_for(pieces.size(), [&](std::size_t i) {
            std::vector<float> &from = array_of(pieces[i], k);
            std::ranges::copy(from, to.begin() + std::ptrdiff_t(first_sample[i]));
            from = {};
        });
    }
    whole.begin.reserve(pixels + 1); // first touched after the memory that it replaces was freed
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        for (std::size_t j = 0; j + 1 < pieces[i].begin.size(); ++j)
            whole.begin.push_back(first_sample[i] + pieces[i].begin[j]);
        pieces[i].begin = {};
    }
    whole.begin.push_back(first_sample.back());
    return whole;
}

void append_pixels(Ldi &whole, const Ldi &piece) {
    const std::uint64_t before = whole.samples();
    for (std::size_t k = 0; k < arrays_beside_values + whole.values.size(); ++k) {
        const std::vector<float> &from = array_of(piece, k);
        array_of(whole, k).insert(array_of(whole, k).end(), from.begin(), from.end());
    }
    for (std::size_t i = 1; i < piece.begin.size(); ++i) whole.begin.push_back(before + piece.begin[i]);
}

void insert_samples(Ldi &ldi, const Ldi &added) {
    std::vector<std::uint64_t> before; // the sample of `ldi` that follows each of `added`
    for (std::size_t pixel = 0; pixel + 1 < ldi.begin.size(); ++pixel) {
        auto [next, end] = ldi.pixel(pixel);
        for (const std::uint64_t i : added.pixel(pixel)) {
            while (next < end && ldi.z[next] <= added.z[i]) ++next;
            before.push_back(next);
        }
    }
    for (std::size_t k = 0; k < arrays_beside_values + ldi.values.size(); ++k) {
        std::vector<float> &array = array_of(ldi, k);
        if (array.empty()) continue;
        const std::size_t size = array.size();
        array.resize(size + before.size());
        auto end = array.begin() + std::ptrdiff_t(size); // of what has not moved yet
        for (std::size_t n = before.size(); n-- > 0;) {
            const auto from = array.begin() + std::ptrdiff_t(before[n]);
            std::move_backward(from, end, end + std::ptrdiff_t(n) + 1);
            *(from + std::ptrdiff_t(n)) = array_of(added, k)[n];
            end = from;
        }
    }
    for (std::size_t pixel = 0; pixel < ldi.begin.size(); ++pixel) ldi.begin[pixel] += added.begin[pixel];
}

} // namespace sparselens
