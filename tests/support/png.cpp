#include "support/png.h"

#include <zlib.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace sparselens {

namespace {

using Bytes = std::vector<std::uint8_t>;

void require(bool holds, const char *what) {
    if (!holds) throw std::runtime_error(std::string("PNG: ") + what);
}

// The rest of the file.
class Reader {
public:
    explicit Reader(const std::string &file) {
        std::ifstream in(file, std::ios::binary);
        bytes_.assign(std::istreambuf_iterator<char>(in), {});
    }
    Bytes take(std::size_t count) {
        require(count <= bytes_.size() - at_, "it ends early");
        const auto first = bytes_.begin() + std::ptrdiff_t(at_);
        at_ += count;
        return {first, first + std::ptrdiff_t(count)};
    }
    std::uint32_t number() {
        const Bytes b = take(4);
        return std::uint32_t(b[0]) << 24 | std::uint32_t(b[1]) << 16 | std::uint32_t(b[2]) << 8 | b[3];
    }
    bool ended() const { return at_ == bytes_.size(); }

private:
    Bytes bytes_;
    std::size_t at_ = 0;
};

struct Chunk {
    std::string type;
    Bytes data;
};

Chunk next_chunk(Reader &reader) {
    const std::uint32_t length = reader.number();
    const Bytes checked = reader.take(4 + std::size_t(length));
    require(crc32(0, checked.data(), uInt(checked.size())) == reader.number(), "a checksum is wrong");
    return {{checked.begin(), checked.begin() + 4}, {checked.begin() + 4, checked.end()}};
}

// Predicts a byte from its left, upper and upper left neighbours (section 9.4).
int paeth(int left, int above, int above_left) {
    const int estimate = left + above - above_left;
    const int to_left = std::abs(estimate - left), to_above = std::abs(estimate - above),
              to_both = std::abs(estimate - above_left);
    if (to_left <= to_above && to_left <= to_both) return left;
    return to_above <= to_both ? above : above_left;
}

// Section 9: each row begins with the number of its filter.
Bytes without_filters(const Bytes &filtered, std::size_t row_bytes) {
    Bytes rows;
    for (std::size_t at = 0; at < filtered.size(); at += row_bytes + 1)
        for (std::size_t i = 0; i < row_bytes; ++i) {
            const std::size_t here = rows.size();
            const bool first_row = at == 0, first_pixel = i < 3;
            const int left = first_pixel ? 0 : rows[here - 3], above = first_row ? 0 : rows[here - row_bytes];
            const int above_left = first_row || first_pixel ? 0 : rows[here - row_bytes - 3];
            const int filter = filtered[at];
            require(filter <= 4, "an unknown filter");
            const int predicted[] = {0, left, above, (left + above) / 2, paeth(left, above, above_left)};
            rows.push_back(std::uint8_t(filtered[at + 1 + i] + predicted[filter]));
        }
    return rows;
}

} // namespace

Png read_png(const std::string &file) {
    Reader reader(file);
    require(reader.take(8) == Bytes{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'}, "another signature");
    Png png;
    Bytes packed;
    for (std::string type; type != "IEND";) {
        const Chunk chunk = next_chunk(reader);
        type = chunk.type;
        if (type == "IDAT") packed.insert(packed.end(), chunk.data.begin(), chunk.data.end());
        if (type != "IHDR") continue;
        const Bytes &d = chunk.data;
        require(d.size() == 13 && d[8] == 8 && d[9] == 2 && d[12] == 0, "not 8 bits RGB in one pass");
        png.width = d[0] << 24 | d[1] << 16 | d[2] << 8 | d[3];
        png.height = d[4] << 24 | d[5] << 16 | d[6] << 8 | d[7];
    }
    require(reader.ended(), "something after the end");
    const std::size_t row_bytes = std::size_t(png.width) * 3;
    Bytes filtered(std::size_t(png.height) * (row_bytes + 1));
    uLongf size = filtered.size();
    require(uncompress(filtered.data(), &size, packed.data(), packed.size()) == Z_OK,
            "not compressed by zlib");
    require(size == filtered.size(), "another number of rows");
    png.rgb = without_filters(filtered, row_bytes);
    return png;
}

} // namespace sparselens
