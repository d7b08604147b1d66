// The samples of an LDI in less memory: values that halves hold take two bytes, as they do in most files, and next to none
// where most of them are one and the same, as coverage often is. They come back as they were, bit by bit. For pictures that are
// worked on a few rows at a time.
#pragma once

#include "ldi.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace sparselens {

class PackedFloats {
public:
    PackedFloats() = default;
    explicit PackedFloats(std::span<const float> values);

    // Sets `to` to the values from number `from` on.
    void unpack(std::size_t from, std::span<float> to) const;
    std::size_t bytes() const;

private:
    using Other = std::pair<std::uint32_t, float>;

    float most_ = 0; // what most values are, where there are neither of the next
    std::vector<std::uint16_t> halves_;
    std::vector<float> floats_; // in place of halves where too many values are none
    std::vector<Other> others_; // values that are not those, by their number
};

class PackedRows {
public:
    // Of a picture of these windows, of which no row is there yet.
    explicit PackedRows(const Windows &windows) : windows_(windows), rows_{0} {}

    // The rows below those that are there, of the same channels.
    void append(const Ldi &rows);

    // Rows [first, last] (EXR coordinates) of the picture as an LDI of those rows.
    Ldi rows(int first, int last) const;

    // Forgets all channels but these, whose order it takes.
    void keep_channels(std::span<const Channel> channels);

    const Windows &windows() const { return windows_; }
    const std::vector<Channel> &channels() const { return channels_; }
    std::uint64_t samples() const { return rows_.back(); }
    // Of rows [first, last].
    std::uint64_t samples(int first, int last) const;
    std::size_t bytes() const; // of all that is held

private:
    struct Piece {                        // some rows
        std::uint64_t begin, end;         // samples of the picture
        std::vector<PackedFloats> arrays; // as arrays_of() lists them; of none that is empty
    };
    std::uint64_t begin_of_row(int y) const;

    Windows windows_;
    std::vector<Channel> channels_;
    std::vector<std::uint64_t> rows_; // where the samples of each row begin, so far; at last, where they end
    std::vector<std::uint32_t> in_row_; // ... those of each pixel, after those of the row's first
    std::vector<bool> present_;         // of the arrays
    std::vector<Piece> pieces_;
};

// Bytes that so many samples take as floats, with what is gathered from them.
double bytes_to_gather(std::uint64_t samples, std::span<const Channel> channels);

// Bytes that samples may take, with what is gathered from them, where the file has so many: with the picture, deep files of ten
// samples a pixel and more stay within 24 for each sample and 100 for each pixel, beside 32 MB. It is more for each pixel and
// less for each sample than that, so that LDIs of opaque views, of one or two samples a pixel, are gathered at once: bands
// would take them half as long again and save a tenth of the memory.
double memory_to_gather(std::uint64_t samples_in_file, std::size_t pixels);

// `rows` in the window that begins with row `top`: the pixels above them have no samples.
Ldi with_empty_above(Ldi rows, int top);

// All arrays of an LDI that have one entry a sample, those of its channels last.
std::vector<std::vector<float> *> arrays_of(Ldi &ldi);
std::vector<const std::vector<float> *> arrays_of(const Ldi &ldi);

} // namespace sparselens
