// PNG and JPEG by libpng and libjpeg alone, for both modules of io/display/oiio_module.h: one reader, so that an archive
// without OpenImageIO reads the same pixels, and because OpenImageIO's takes half a JPEG for a whole one.
#pragma once

#include "io/display/oiio_module.h"

// jpeglib.h needs <cstdio>.
// clang-format off
#include <cstdio>
#include <jpeglib.h>
#include <jerror.h>
#include <png.h>
// clang-format on

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace sparselens {

// A file while it is read. It owns the bytes of its description.
struct PictureFile {
    float *values = nullptr; // null: only a description is wanted
    OiioFile before{};       // what was said then
    OiioFile said{};
    std::string profile = {}, exif = {};

    int stored_width() const { return said.orientation > 4 ? said.height : said.width; }
    int stored_height() const { return said.orientation > 4 ? said.width : said.height; }
    void set_stored_size(int width, int height) {
        const bool on_side = said.orientation > 4; // rows and columns change places
        said.width = on_side ? height : width, said.height = on_side ? width : height;
    }
    bool wants_pixels() const {
        if (!values) return false;
        if (said.width != before.width || said.height != before.height || said.alpha != before.alpha)
            throw std::runtime_error("it has changed");
        return true;
    }
    // Puts a stored row in its place: grey, grey and A, R G B, or R G B A.
    void put_row(int y, const float *row, int channels) const {
        const int width = stored_width(), height = stored_height();
        const std::size_t pixels = std::size_t(width) * std::size_t(height);
        for (int x = 0; x < width; ++x, row += channels) {
            const std::size_t at = upright(x, y, width, height, said.orientation);
            for (std::size_t k = 0; k < 3; ++k) values[k * pixels + at] = row[channels < 3 ? 0 : k];
            if (said.alpha) values[3 * pixels + at] = row[channels < 3 ? 1 : 3];
        }
    }
};

// Where the two bytes of the orientation begin in an Exif, and what they say; null if it has none.
inline char *orientation_in(std::string &exif, std::size_t &value) {
    if (exif.empty()) return nullptr;
    const auto number = [&](std::size_t at, std::size_t size) {
        std::size_t found = 0;
        for (std::size_t i = 0; i < size && at + size <= exif.size(); ++i)
            found = found << 8 | std::uint8_t(exif[exif[0] == 'M' ? at + i : at + size - 1 - i]);
        return found;
    };
    const std::size_t first = number(4, 4), count = number(first, 2);
    for (std::size_t entry = first + 2; entry < first + 2 + 12 * count && entry + 12 <= exif.size();
         entry += 12)
        if (number(entry, 2) == 0x112) {
            value = number(entry + 8, 2);
            return &exif[entry + 8];
        }
    return nullptr;
}

constexpr std::string_view exif_begin("Exif\0\0", 6); // of JPEG, and by mistake of WebP

// Takes the orientation out of an Exif, which then says 1.
inline int take_orientation(std::string &exif) {
    if (exif.starts_with(exif_begin)) exif.erase(0, exif_begin.size());
    std::size_t value = 1;
    char *const at = orientation_in(exif, value);
    if (at) at[0] = exif[0] == 'M' ? 0 : 1, at[1] = exif[0] == 'M' ? 1 : 0;
    return value >= 1 && value <= 8 ? int(value) : 1;
}

// The bytes of the first chunk of that name in a PNG, or in a file of RIFF such as WebP.
inline std::string chunk_of(std::FILE *file, std::string_view name, bool riff) {
    constexpr std::uint32_t most = 1 << 26;
    std::array<char, 8> head{};
    std::fseek(file, riff ? 12 : 8, SEEK_SET);
    while (std::fread(head.data(), 1, head.size(), file) == head.size()) {
        std::uint32_t size = 0;
        for (std::size_t i = 0; i < 4; ++i) size = size << 8 | std::uint8_t(head[riff ? 7 - i : i]);
        if (std::string_view(&head[riff ? 0 : 4], 4) != name) {
            std::fseek(file, long(size) + (riff ? size % 2 : 4), SEEK_CUR);
            continue;
        }
        std::string bytes(std::min(size, most), '\0');
        bytes.resize(std::fread(bytes.data(), 1, bytes.size(), file));
        return bytes;
    }
    return {};
}

namespace png {

// libpng reports an error by a function that must not return.
[[noreturn]] inline void failed(png_structp, png_const_charp why) { throw std::runtime_error(why); }
inline void warned(png_structp, png_const_charp) {}

struct Reader {
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, failed, warned);
    png_infop info = png_create_info_struct(png);
    ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
};
struct Writer {
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, failed, warned);
    png_infop info = png_create_info_struct(png);
    ~Writer() { png_destroy_write_struct(&png, &info); }
};

inline void read_pixels(const Reader &reader, const PictureFile &to) {
    const bool deep = png_get_bit_depth(reader.png, reader.info) == 16;
    const std::size_t bytes = png_get_rowbytes(reader.png, reader.info),
                      height = std::size_t(to.stored_height());
    std::vector<std::uint8_t> all(bytes * height); // an interlaced picture comes whole
    std::vector<png_bytep> rows;
    for (std::size_t y = 0; y < height; ++y) rows.push_back(&all[y * bytes]);
    png_read_image(reader.png, rows.data());
    png_read_end(reader.png, nullptr);
    std::vector<float> row(deep ? bytes / 2 : bytes);
    for (std::size_t y = 0; y < height; ++y) {
        const std::uint8_t *from = rows[y];
        for (std::size_t n = 0; n < row.size(); ++n)
            row[n] = deep ? float(from[2 * n] << 8 | from[2 * n + 1]) / 65535 : float(from[n]) / 255;
        to.put_row(int(y), row.data(), png_get_channels(reader.png, reader.info));
    }
}

inline void read(std::FILE *file, PictureFile &to) {
    to.exif = chunk_of(file, "eXIf", false);
    std::rewind(file);
    const Reader reader;
    png_init_io(reader.png, file);
    png_read_info(reader.png, reader.info);
    png_bytep bytes = nullptr;
    png_charp name = nullptr;
    png_uint_32 size = 0;
    int compression = 0;
    if (png_get_iCCP(reader.png, reader.info, &name, &compression, &bytes, &size))
        to.profile.assign(reinterpret_cast<char *>(bytes), size);
    png_set_expand(reader.png);
    png_read_update_info(reader.png, reader.info);
    to.said.orientation = take_orientation(to.exif);
    to.set_stored_size(int(png_get_image_width(reader.png, reader.info)),
                       int(png_get_image_height(reader.png, reader.info)));
    const float aspect = png_get_pixel_aspect_ratio(reader.png, reader.info);
    to.said.pixel_aspect = aspect > 0 ? aspect : 1;
    to.said.bits = png_get_bit_depth(reader.png, reader.info);
    to.said.alpha = png_get_channels(reader.png, reader.info) % 2 == 0;
    if (to.wants_pixels()) read_pixels(reader, to);
}

inline void write(const OiioPicture &picture) {
    const Writer writer;
    const auto put = [](png_structp png, png_bytep piece, std::size_t count) {
        const auto &to = *static_cast<const OiioPicture *>(png_get_io_ptr(png));
        to.put(to.bytes, piece, count);
    };
    png_set_write_fn(writer.png, const_cast<OiioPicture *>(&picture), put, nullptr);
    png_set_benign_errors(writer.png, 1); // a damaged profile is left out
    png_set_IHDR(writer.png, writer.info, png_uint_32(picture.width), png_uint_32(picture.height),
                 picture.bits, picture.channels == 4 ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_pHYs(writer.png, writer.info, 100, png_uint_32(std::lround(100 * picture.pixel_aspect)),
                 PNG_RESOLUTION_UNKNOWN);
    const auto bytes_of = [](const OiioBytes &of) { return static_cast<png_const_bytep>(of.bytes); };
    if (picture.profile.size > 0)
        png_set_iCCP(writer.png, writer.info, "ICC", PNG_COMPRESSION_TYPE_BASE, bytes_of(picture.profile),
                     png_uint_32(picture.profile.size));
    if (picture.exif.size > 0)
        png_set_eXIf_1(writer.png, writer.info, png_uint_32(picture.exif.size),
                       const_cast<png_bytep>(bytes_of(picture.exif)));
    png_write_info(writer.png, writer.info);
    const bool deep = picture.bits == 16;
    std::vector<std::uint8_t> row;
    for (int y = 0; y < picture.height; ++y) {
        row.clear();
        for (const float value : std::span(picture.row(picture.source, y),
                                           std::size_t(picture.width) * std::size_t(picture.channels))) {
            const float scaled = value * 65535 + 0.5f;
            const unsigned number = !deep         ? in_8_bits(value)
                                    : scaled >= 0 ? unsigned(std::min(scaled, 65535.0f))
                                                  : 0;
            if (deep) row.push_back(std::uint8_t(number >> 8));
            row.push_back(std::uint8_t(number));
        }
        png_write_row(writer.png, row.data());
    }
    png_write_end(writer.png, nullptr);
}

} // namespace png

namespace jpeg {

[[noreturn]] inline void failed(j_common_ptr at) {
    std::array<char, JMSG_LENGTH_MAX> why{};
    at->err->format_message(at, why.data());
    throw std::runtime_error(why.data());
}

// libjpeg makes up what is missing from a file, and warns.
inline void warned(j_common_ptr at, int level) {
    const int code = at->err->msg_code;
    if (level < 0 && (code == JWRN_JPEG_EOF || code == JWRN_HIT_MARKER || code == JWRN_HUFF_BAD_CODE ||
                      code == JWRN_ARITH_BAD_CODE || code == JWRN_MUST_RESYNC))
        throw std::runtime_error("a part of the file is missing or damaged");
}

inline std::string exif_of(const jpeg_decompress_struct &file) {
    for (auto marker = file.marker_list; marker; marker = marker->next) {
        const std::string_view bytes(reinterpret_cast<const char *>(marker->data), marker->data_length);
        if (bytes.starts_with(exif_begin)) return std::string(bytes);
    }
    return {};
}

inline void read_pixels(jpeg_decompress_struct &jpeg, const PictureFile &to) {
    const bool inks = jpeg.jpeg_color_space == JCS_CMYK || jpeg.jpeg_color_space == JCS_YCCK;
    jpeg.out_color_space = inks ? JCS_CMYK : JCS_RGB;
    jpeg_start_decompress(&jpeg);
    std::vector<std::uint8_t> row(std::size_t(jpeg.output_width) * (inks ? 4 : 3));
    std::vector<float> values(row.size());
    while (jpeg.output_scanline < jpeg.output_height) {
        const int y = int(jpeg.output_scanline);
        JSAMPROW into = row.data();
        jpeg_read_scanlines(&jpeg, &into, 1);
        for (std::size_t n = 0; n < row.size(); ++n) // inks are stored as what they leave, black last
            values[n] = float(row[n]) / 255 * (inks ? float(row[n | 3]) / 255 : 1);
        to.put_row(y, values.data(), inks ? 4 : 3);
    }
    jpeg_finish_decompress(&jpeg);
}

inline void read(std::FILE *file, PictureFile &to) {
    struct Reader {
        jpeg_error_mgr errors{};
        jpeg_decompress_struct jpeg{};
        ~Reader() { jpeg_destroy_decompress(&jpeg); }
    } reader;
    jpeg_decompress_struct &jpeg = reader.jpeg;
    jpeg.err = jpeg_std_error(&reader.errors);
    reader.errors.emit_message = warned;
    reader.errors.error_exit = failed;
    jpeg_create_decompress(&jpeg);
    jpeg_stdio_src(&jpeg, file);
    for (const int marker : {1, 2}) jpeg_save_markers(&jpeg, JPEG_APP0 + marker, 0xffff); // Exif and ICC
    jpeg_read_header(&jpeg, TRUE);
    to.exif = exif_of(jpeg);
    JOCTET *profile = nullptr;
    unsigned size = 0;
    if (jpeg_read_icc_profile(&jpeg, &profile, &size))
        to.profile.assign(reinterpret_cast<char *>(profile), size);
    std::free(profile);
    to.said.orientation = take_orientation(to.exif);
    to.set_stored_size(int(jpeg.image_width), int(jpeg.image_height));
    to.said.pixel_aspect = jpeg.X_density > 0 && jpeg.Y_density > 0
                               ? float(jpeg.X_density) / float(jpeg.Y_density) // as OpenImageIO reads it
                               : 1;
    to.said.bits = 8;
    if (to.wants_pixels()) read_pixels(jpeg, to);
}

} // namespace jpeg

using FilePointer = std::unique_ptr<std::FILE, int (*)(std::FILE *)>;
inline FilePointer opened(const char *path) {
    FilePointer file(std::fopen(path, "rb"), std::fclose);
    if (!file) throw std::runtime_error(std::strerror(errno));
    return file;
}

// Returns false if the file is neither a PNG nor a JPEG.
inline bool read_png_or_jpeg(const char *path, PictureFile &to) {
    const FilePointer file = opened(path);
    const int first = std::fgetc(file.get());
    std::rewind(file.get());
    if (first != 0x89 && first != 0xff) return false;
    first == 0xff ? jpeg::read(file.get(), to) : png::read(file.get(), to);
    return true;
}

// The read function of a module: `work` reads a PictureFile.
template <typename Work>
void read_into(OiioFile &file, float *values, const Work &work) {
    thread_local PictureFile last; // its bytes outlive the call
    last = {.values = values, .before = file};
    work(last);
    last.said.profile = {last.profile.data(), last.profile.size()};
    last.said.exif = {last.exif.data(), last.exif.size()};
    file = last.said;
}

// Returns null, or why the work fails.
template <typename Work>
const char *failure_of(const Work &work) try {
    work();
    return nullptr;
} catch (const std::exception &error) {
    thread_local std::string why;
    why = error.what();
    return why.c_str();
}

} // namespace sparselens
