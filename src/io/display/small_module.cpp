// Writes PNG by libpng alone: the module of io/display/oiio_module.h for archives, where OpenImageIO would bring two
// hundred libraries (tools/bundle.sh). Its pixels equal OpenImageIO's.
#include "io/display/oiio_module.h"

#include <png.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
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
    const std::unique_ptr<std::FILE, int (*)(std::FILE *)> file(std::fopen(picture.path, "wb"), std::fclose);
    if (!file) throw std::runtime_error("the file cannot be opened");
    png_init_io(writer.png, file.get());
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
    if (std::fflush(file.get()) != 0) throw std::runtime_error("the file cannot be written to its end");
}

const char *write(const OiioPicture &picture) try {
    write_file(picture);
    return nullptr;
} catch (const std::exception &error) {
    thread_local std::string why;
    why = error.what();
    return why.c_str();
}

const char *read(const char *, OiioSize &, float *) { return "this archive lacks OpenImageIO: give an EXR"; }

} // namespace

extern "C" OiioModule sparselens_oiio_module() { return {support, write, read}; }

} // namespace sparselens
