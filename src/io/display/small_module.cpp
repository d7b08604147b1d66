// Writes PNG, and reads PNG and JPEG, by libpng and libjpeg alone: the module of io/display/oiio_module.h for archives,
// where OpenImageIO would bring two hundred libraries (tools/bundle.sh). Its pixels equal OpenImageIO's.
#include "io/display/oiio_module.h"

// jpeglib.h needs <cstdio>.
// clang-format off
#include <cstdio>
#include <jpeglib.h>
#include <png.h>
// clang-format on

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace sparselens {

namespace {

OiioModule::Support support(const char *extension) {
    return extension == std::string("png") ? OiioModule::Support::alpha : OiioModule::Support::none;
}

// libpng reports an error by a function that must not return.
[[noreturn]] void failed(png_structp, png_const_charp why) { throw std::runtime_error(why); }
void warned(png_structp, png_const_charp) {}

void write_file(const OiioPicture &picture) {
    struct Writer {
        png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, failed, warned);
        png_infop info = png_create_info_struct(png);
        ~Writer() { png_destroy_write_struct(&png, &info); }
    } writer;
    const auto put = [](png_structp png, png_bytep piece, std::size_t count) {
        const auto &to = *static_cast<const OiioPicture *>(png_get_io_ptr(png));
        to.put(to.bytes, piece, count);
    };
    png_set_write_fn(writer.png, const_cast<OiioPicture *>(&picture), put, nullptr);
    png_set_IHDR(writer.png, writer.info, png_uint_32(picture.width), png_uint_32(picture.height), 8,
                 picture.channels == 4 ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_pHYs(writer.png, writer.info, 100, png_uint_32(std::lround(100 * picture.pixel_aspect)),
                 PNG_RESOLUTION_UNKNOWN);
    png_write_info(writer.png, writer.info);
    std::vector<std::uint8_t> row(std::size_t(picture.width) * std::size_t(picture.channels));
    for (int y = 0; y < picture.height; ++y) {
        const float *values = picture.row(picture.source, y);
        std::transform(values, values + row.size(), row.begin(), in_8_bits);
        png_write_row(writer.png, row.data());
    }
    png_write_end(writer.png, nullptr);
}

// The pixels of a file as they are stored, and how they are turned (Exif, 1 to 8).
struct Stored {
    int width = 0, height = 0, orientation = 1;
    float pixel_aspect = 1;
    std::vector<float> values = {}; // R, G, B of each pixel; empty if they were not asked for
};

Stored read_png(std::FILE *file, bool values) {
    struct Reader {
        png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, failed, warned);
        png_infop info = png_create_info_struct(png);
        ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
    } reader;
    png_init_io(reader.png, file);
    png_read_info(reader.png, reader.info);
    Stored stored;
    stored.width = int(png_get_image_width(reader.png, reader.info));
    stored.height = int(png_get_image_height(reader.png, reader.info));
    if (const float aspect = png_get_pixel_aspect_ratio(reader.png, reader.info); aspect > 0)
        stored.pixel_aspect = aspect;
    if (!values) return stored;
    png_set_expand(reader.png);
    png_set_gray_to_rgb(reader.png);
    png_read_update_info(reader.png, reader.info);
    const bool deep = png_get_bit_depth(reader.png, reader.info) == 16;
    const std::size_t bytes = png_get_rowbytes(reader.png, reader.info), height = std::size_t(stored.height),
                      channels = png_get_channels(reader.png, reader.info);
    std::vector<std::uint8_t> all(bytes * height);
    std::vector<png_bytep> rows;
    for (std::size_t y = 0; y < height; ++y) rows.push_back(&all[y * bytes]);
    png_read_image(reader.png, rows.data());
    const auto value = [&](std::size_t n) {
        return deep ? float(all[2 * n] << 8 | all[2 * n + 1]) / 65535 : float(all[n]) / 255;
    };
    for (std::size_t n = 0; n < std::size_t(stored.width) * height * channels; n += channels)
        for (std::size_t k = 0; k < 3; ++k)
            stored.values.push_back(value(n + k) * (channels == 4 ? value(n + 3) : 1));
    return stored;
}

// What the Exif of a file says about its orientation; 1 if it says nothing.
int orientation_of(const jpeg_decompress_struct &file) {
    for (auto marker = file.marker_list; marker; marker = marker->next) {
        const std::span<const std::uint8_t> bytes(marker->data, marker->data_length);
        if (bytes.size() < 14 || std::memcmp(bytes.data(), "Exif\0", 6) != 0) continue;
        const std::span<const std::uint8_t> tiff = bytes.subspan(6);
        const auto number = [&](std::size_t at, std::size_t size) {
            std::size_t value = 0;
            for (std::size_t i = 0; i < size && at + size <= tiff.size(); ++i)
                value = value << 8 | tiff[tiff[0] == 'M' ? at + i : at + size - 1 - i];
            return value;
        };
        const std::size_t first = number(4, 4), count = number(first, 2);
        for (std::size_t entry = first + 2; entry < first + 2 + 12 * count; entry += 12)
            if (const auto turned = int(number(entry + 8, 2)); number(entry, 2) == 0x112)
                return turned >= 1 && turned <= 8 ? turned : 1;
    }
    return 1;
}

Stored read_jpeg(std::FILE *file, bool values) {
    struct Reader {
        jpeg_error_mgr errors{};
        jpeg_decompress_struct jpeg{};
        ~Reader() { jpeg_destroy_decompress(&jpeg); }
    } reader;
    jpeg_decompress_struct &jpeg = reader.jpeg;
    jpeg.err = jpeg_std_error(&reader.errors);
    reader.errors.output_message = [](j_common_ptr) {};
    reader.errors.error_exit = [](j_common_ptr at) {
        std::array<char, JMSG_LENGTH_MAX> why{};
        at->err->format_message(at, why.data());
        throw std::runtime_error(why.data());
    };
    jpeg_create_decompress(&jpeg);
    jpeg_stdio_src(&jpeg, file);
    jpeg_save_markers(&jpeg, JPEG_APP0 + 1, 0xffff);
    jpeg_read_header(&jpeg, TRUE);
    Stored stored{int(jpeg.image_width), int(jpeg.image_height), orientation_of(jpeg)};
    if (jpeg.X_density > 0 && jpeg.Y_density > 0)
        stored.pixel_aspect = float(jpeg.X_density) / float(jpeg.Y_density); // as OpenImageIO reads it
    if (!values) return stored;
    jpeg.out_color_space = JCS_RGB;
    jpeg_start_decompress(&jpeg);
    std::vector<std::uint8_t> row(std::size_t(stored.width) * 3);
    for (JSAMPROW to = row.data(); jpeg.output_scanline < jpeg.output_height;) {
        jpeg_read_scanlines(&jpeg, &to, 1);
        for (const std::uint8_t v : row) stored.values.push_back(float(v) / 255);
    }
    jpeg_finish_decompress(&jpeg);
    return stored;
}

void read_file(const char *path, OiioSize &size, float *values) {
    const std::unique_ptr<std::FILE, int (*)(std::FILE *)> file(std::fopen(path, "rb"), std::fclose);
    if (!file) throw std::runtime_error("the file cannot be opened");
    const int first = std::fgetc(file.get());
    std::rewind(file.get());
    if (first != 0x89 && first != 0xff)
        throw std::runtime_error("this archive reads PNG and JPEG: convert it (oiiotool IN -o OUT.png)");
    const Stored stored = first == 0xff ? read_jpeg(file.get(), values) : read_png(file.get(), values);
    const bool on_side = stored.orientation > 4;
    const int width = on_side ? stored.height : stored.width, height = on_side ? stored.width : stored.height;
    if (!values) size = {width, height, stored.pixel_aspect, false};
    if (width != size.width || height != size.height) throw std::runtime_error("it has changed");
    const std::size_t pixels = stored.values.size() / 3;
    const float *from = stored.values.data();
    for (int y = 0; values && y < stored.height; ++y)
        for (int x = 0; x < stored.width; ++x, from += 3)
            for (std::size_t k = 0; k < 3; ++k)
                values[k * pixels + upright(x, y, stored.width, stored.height, stored.orientation)] = from[k];
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

const char *write(const OiioPicture &picture) {
    return failure_of([&] { write_file(picture); });
}
const char *read(const char *path, OiioSize &size, float *values) {
    return failure_of([&] { read_file(path, size, values); });
}

} // namespace

extern "C" OiioModule sparselens_oiio_module() { return {support, write, read}; }

} // namespace sparselens
