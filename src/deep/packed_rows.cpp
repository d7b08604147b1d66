#include "deep/packed_rows.h"

#include "base/image.h"
#include "base/parallel.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <limits>

namespace sparselens {

namespace {

template <typename Values, typename Picture>
std::vector<Values *> list_arrays(Picture &ldi) {
    std::vector<Values *> arrays{&ldi.z,      &ldi.z_back,  &ldi.dx,   &ldi.dy,
                                 &ldi.weight, &ldi.image_z, &ldi.solid};
    for (auto &values : ldi.values) arrays.push_back(&values);
    return arrays;
}

bool same_bits(float a, float b) {
    return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

// The value that more than half of the values have, if there is one; otherwise any of them.
float majority(std::span<const float> values) {
    float found = 0;
    std::size_t lead = 0;
    for (const float value : values)
        if (lead == 0)
            found = value, lead = 1;
        else if (same_bits(value, found))
            ++lead;
        else
            --lead;
    return found;
}

} // namespace

PackedFloats::PackedFloats(std::span<const float> values) : most_(majority(values)) {
    assert(values.size() <= std::numeric_limits<std::uint32_t>::max());
    const std::size_t most = values.size() / 4; // exceptions; each takes as much memory as four halves
    // Sets others_ to the values that are not `as_they_are`. Returns false if there are too many.
    const auto find_others = [&](const auto &as_they_are) {
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (as_they_are(values[i])) continue;
            if (others_.size() == most) return std::vector<Other>().swap(others_), false;
            others_.emplace_back(std::uint32_t(i), values[i]);
        }
        others_.shrink_to_fit();
        return true;
    };
    if (find_others([&](float value) { return same_bits(value, most_); })) return;
    if (find_others(is_half)) {
        halves_.resize(values.size());
        std::ranges::transform(values, halves_.begin(), bits_of_half);
    } else {
        floats_.assign(values.begin(), values.end());
    }
}

void PackedFloats::unpack(std::size_t from, std::span<float> to) const {
    if (!floats_.empty()) {
        std::copy_n(floats_.begin() + std::ptrdiff_t(from), to.size(), to.begin());
        return;
    }
    if (halves_.empty())
        std::ranges::fill(to, most_);
    else
        std::ranges::transform(std::span(halves_).subspan(from, to.size()), to.begin(), of_half);
    auto other = std::ranges::lower_bound(others_, from, {}, &Other::first);
    for (; other != others_.end() && other->first < from + to.size(); ++other)
        to[other->first - from] = other->second;
}

std::size_t PackedFloats::bytes() const {
    return halves_.capacity() * sizeof(halves_[0]) + others_.capacity() * sizeof(others_[0]) +
           floats_.capacity() * sizeof(floats_[0]);
}

std::vector<std::vector<float> *> arrays_of(Ldi &ldi) { return list_arrays<std::vector<float>>(ldi); }

std::vector<const std::vector<float> *> arrays_of(const Ldi &ldi) {
    return list_arrays<const std::vector<float>>(ldi);
}

void PackedRows::append(const Ldi &rows) {
    const std::vector<const std::vector<float> *> arrays = arrays_of(rows);
    if (rows_.size() == 1) {
        channels_ = rows.channels;
        in_row_.reserve(windows_.pixels());
        present_.resize(arrays.size());
    }
    assert(rows.channels == channels_);
    for (std::size_t k = 0; k < arrays.size(); ++k) present_[k] = present_[k] || !arrays[k]->empty();
    const std::uint64_t before = rows_.back();
    const auto width = std::size_t(windows_.width());
    for (std::size_t row = 0; row + 1 < rows.begin.size(); row += width) {
        for (std::size_t x = 0; x < width; ++x)
            in_row_.push_back(std::uint32_t(rows.begin[row + x] - rows.begin[row]));
        rows_.push_back(before + rows.begin[row + width]);
    }
    Piece piece{before, rows_.back(), std::vector<PackedFloats>(arrays.size())};
    parallel_for(arrays.size(), [&](std::size_t k) { piece.arrays[k] = PackedFloats(*arrays[k]); });
    pieces_.push_back(std::move(piece));
}

void PackedRows::keep_channels(std::span<const Channel> channels) {
    const std::size_t places = present_.size() - channels_.size(); // arrays that hold no channel
    std::vector<std::size_t> kept;
    for (std::size_t k = 0; k < places; ++k) kept.push_back(k);
    for (const Channel &channel : channels) kept.push_back(places + find_channel(channels_, channel.name));
    std::vector<bool> present;
    for (const std::size_t k : kept) present.push_back(present_[k]);
    for (Piece &piece : pieces_) {
        std::vector<PackedFloats> arrays;
        for (const std::size_t k : kept) arrays.push_back(std::move(piece.arrays[k]));
        piece.arrays = std::move(arrays);
    }
    present_ = std::move(present);
    channels_.assign(channels.begin(), channels.end());
}

std::uint64_t PackedRows::begin_of_row(int y) const { return rows_[std::size_t(y - windows_.data.min.y)]; }

std::uint64_t PackedRows::samples(int first, int last) const {
    return begin_of_row(last + 1) - begin_of_row(first);
}

Ldi PackedRows::rows(int first, int last) const {
    Ldi ldi;
    ldi.windows = windows_;
    ldi.windows.data.min.y = first;
    ldi.windows.data.max.y = last;
    ldi.channels = channels_;
    ldi.values.resize(channels_.size());
    const std::uint64_t from = begin_of_row(first), to = begin_of_row(last + 1);
    ldi.begin.reserve(ldi.windows.pixels() + 1);
    for (int y = first; y <= last; ++y)
        for (int x = windows_.data.min.x; x <= windows_.data.max.x; ++x)
            ldi.begin.push_back(begin_of_row(y) - from + in_row_[windows_.index(Imath::V2i(x, y))]);
    ldi.begin.push_back(to - from);
    const std::vector<std::vector<float> *> arrays = arrays_of(ldi);
    parallel_for(arrays.size(), [&](std::size_t k) {
        if (present_[k]) arrays[k]->resize(to - from);
    });
    parallel_for(pieces_.size() * arrays.size(), [&](std::size_t i) {
        const Piece &piece = pieces_[i / arrays.size()];
        const std::size_t k = i % arrays.size();
        const std::uint64_t begin = std::max(piece.begin, from), end = std::min(piece.end, to);
        if (!present_[k] || begin >= end) return;
        piece.arrays[k].unpack(begin - piece.begin, std::span(*arrays[k]).subspan(begin - from, end - begin));
    });
    return ldi;
}

std::size_t PackedRows::bytes() const {
    std::size_t sum = rows_.capacity() * sizeof(rows_[0]) + in_row_.capacity() * sizeof(in_row_[0]);
    for (const Piece &piece : pieces_)
        for (const PackedFloats &values : piece.arrays) sum += values.bytes();
    return sum;
}

double bytes_to_gather(std::uint64_t samples, std::span<const Channel> channels) {
    constexpr std::size_t places = 3, prepared = 8; // depth and offsets; floats that BlockedSamples holds
    const std::size_t groups = pieces_of(channels.size(), std::size_t{4});
    const bool by_channel = find_channel(channels, "AR") != npos;
    const std::size_t copied = by_channel ? 2 * (places + 4) : 0; // of one coverage, and merged
    return double(samples) *
           double((places + channels.size() + copied + prepared + 4 * groups) * sizeof(float));
}

double memory_to_gather(std::uint64_t samples_in_file, std::size_t pixels) {
    return 14 * double(samples_in_file) + 110 * double(pixels) + 32 * 1024 * 1024;
}

Ldi with_empty_above(Ldi rows, int top) {
    const std::size_t before = rows.windows.pixels();
    rows.windows.data.min.y = top;
    rows.begin.insert(rows.begin.begin(), rows.windows.pixels() - before, 0);
    return rows;
}

} // namespace sparselens
