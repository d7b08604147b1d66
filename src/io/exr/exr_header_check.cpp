#include "io/exr/exr_header_check.h"

#include "base/error.h"
#include "io/files/file_stream.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace sparselens {

namespace {

constexpr std::uint32_t magic = 20000630, several_parts = 0x1000;
constexpr std::size_t longest_name = 255;

struct FixedSize {
    std::string_view type;
    std::uint64_t bytes;
};
constexpr std::array<FixedSize, 24> fixed_sizes{{{"box2f", 16},
                                                 {"box2i", 16},
                                                 {"chromaticities", 32},
                                                 {"compression", 1},
                                                 {"deepImageState", 1},
                                                 {"double", 8},
                                                 {"envmap", 1},
                                                 {"float", 4},
                                                 {"int", 4},
                                                 {"keycode", 28},
                                                 {"lineOrder", 1},
                                                 {"m33d", 72},
                                                 {"m33f", 36},
                                                 {"m44d", 128},
                                                 {"m44f", 64},
                                                 {"rational", 8},
                                                 {"tiledesc", 9},
                                                 {"timecode", 8},
                                                 {"v2d", 16},
                                                 {"v2f", 8},
                                                 {"v2i", 8},
                                                 {"v3d", 24},
                                                 {"v3f", 12},
                                                 {"v3i", 12}}};

class HeaderWalk {
public:
    HeaderWalk(InputStream &in, const std::string &path) : in_(in), path_(path) {}

    void run() {
        if (in_.bytes() < 8) return;
        if (word() != magic) fail_as_other();
        const bool multipart = (word() & several_parts) != 0;
        bool more = one_header();
        while (more && multipart) more = one_header();
    }

private:
    // Returns false if the header is empty.
    bool one_header() {
        for (bool empty = true;; empty = false) {
            const std::string name = text();
            if (name.empty()) return !empty;
            const std::string type = text();
            check_attribute(name, type, word());
        }
    }

    void check_attribute(const std::string &name, const std::string &type, std::uint64_t bytes) {
        const std::uint64_t begin = in_.tellg();
        if (bytes > in_.bytes() - begin)
            fail(name, fmt::format("claims {} bytes, more than the file has", bytes));
        for (const FixedSize &fixed : fixed_sizes)
            if (fixed.type == type && fixed.bytes != bytes) fail(name, "does not have the size of its type");
        if (type == "chlist" && channels() != begin + bytes)
            fail(name, "does not have the size that it claims");
        if (type == "preview" && !is_preview(bytes)) fail(name, "does not have the size that it claims");
        if (type == "stringvector" && !is_list(begin + bytes))
            fail(name, "does not have the size that it claims");
        in_.seekg(begin + bytes);
    }

    // Returns where a list of channels ends. It holds names with 16 bytes each, then an empty name.
    std::uint64_t channels() {
        while (!text().empty()) skip(16);
        return in_.tellg();
    }
    bool is_preview(std::uint64_t bytes) {
        if (bytes < 8) return false;
        const std::uint64_t width = word(), height = word();
        return width * height == (bytes - 8) / 4 && bytes % 4 == 0;
    }
    bool is_list(std::uint64_t end) {
        while (in_.tellg() + 4 <= end) {
            const std::uint64_t bytes = word();
            if (bytes > end - in_.tellg()) return false;
            skip(bytes);
        }
        return in_.tellg() == end;
    }

    [[noreturn]] void fail_as_other() {
        std::array<char, 16> bytes{};
        in_.seekg(0);
        in_.read(bytes.data(), int(std::min<std::uint64_t>(bytes.size(), in_.bytes())));
        throw Error(display_name(path_) + ": " + not_exr({bytes.data(), bytes.size()}));
    }
    [[noreturn]] void fail(const std::string &name, const std::string &what) const {
        throw Error(fmt::format("{}: attribute {} {}", display_name(path_), name, what));
    }
    void skip(std::uint64_t bytes) {
        const std::uint64_t at = in_.tellg();
        if (bytes > in_.bytes() - at) throw Error(display_name(path_) + ": the file is truncated");
        in_.seekg(at + bytes);
    }
    unsigned char byte() {
        char c;
        in_.read(&c, 1);
        return static_cast<unsigned char>(c);
    }
    std::uint32_t word() { // little-endian
        std::uint32_t value = 0;
        for (int shift = 0; shift < 32; shift += 8) value |= std::uint32_t(byte()) << shift;
        return value;
    }
    std::string text() {
        std::string name;
        for (unsigned char c = byte(); c != 0; c = byte()) {
            name += char(c);
            if (name.size() > longest_name)
                throw Error(display_name(path_) + ": a name in the header does not end");
        }
        return name;
    }

    InputStream &in_;
    const std::string &path_;
};

} // namespace

void check_header(InputStream &in, const std::string &path) {
    HeaderWalk(in, path).run();
    in.seekg(0);
}

} // namespace sparselens
