// The samples of an LDI in less memory, for work on a few rows at a time. Values that are exact as half take two bytes.
// If most values are equal, as coverage often is, they take almost nothing. Unpacking restores every bit.
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

    float most_ = 0; // the most frequent value; used if the next two are empty
    std::vector<std::uint16_t> halves_;
    std::vector<float> floats_; // instead of halves if too many values are not exact as half
    std::vector<Other> others_; // the exceptions, by their index
};

class PackedRows {
public:
    // Begins a picture of these windows, without rows so far.
    explicit PackedRows(const Windows &windows) : windows_(windows), rows_{0} {}

    // Adds the next rows, which have the same channels.
    void append(const Ldi &rows);

    // Rows [first, last] (EXR coordinates) of the picture as an LDI of those rows.
    Ldi rows(int first, int last) const;

    // Keeps these channels only, in this order.
    void keep_channels(std::span<const Channel> channels);

    const Windows &windows() const { return windows_; }
    const std::vector<Channel> &channels() const { return channels_; }
    std::uint64_t samples() const { return rows_.back(); }
    // The number of samples in rows [first, last].
    std::uint64_t samples(int first, int last) const;
    std::size_t bytes() const; // memory used

private:
    struct Piece {                        // some rows
        std::uint64_t begin, end;         // samples of the picture
        std::vector<PackedFloats> arrays; // as arrays_of() lists them
    };
    std::uint64_t begin_of_row(int y) const;

    Windows windows_;
    std::vector<Channel> channels_;
    std::vector<std::uint64_t> rows_;   // the first sample of each row so far, then the end of the last row
    std::vector<std::uint32_t> in_row_; // the first sample of each pixel, counted from its row's first
    std::vector<bool> present_;         // [array]
    std::vector<Piece> pieces_;
};

// Bytes that this number of samples takes as floats, together with the data that the gather makes from them.
double bytes_to_gather(std::uint64_t samples, std::span<const Channel> channels);

// The memory budget in bytes for the samples and the data that the gather makes from them. With the picture, deep files
// of ten or more samples a pixel stay within 24 bytes per sample, 100 per pixel and 32 MB. The budget counts more per
// pixel and less per sample, so that LDIs of one or two samples a pixel are gathered at once: bands would take them
// half as long again and save a tenth of the memory.
double memory_to_gather(std::uint64_t samples_in_file, std::size_t pixels);

// `rows` in a window that begins at row `top`; added pixels have no samples.
Ldi with_empty_above(Ldi rows, int top);

// All arrays of an LDI with one entry per sample; the arrays of its channels come last.
std::vector<std::vector<float> *> arrays_of(Ldi &ldi);
std::vector<const std::vector<float> *> arrays_of(const Ldi &ldi);

} // namespace sparselens
