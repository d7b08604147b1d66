// Writes PNG, JPEG and TIFF by libpng, libjpeg and libtiff alone: the module of io/display/oiio_module.h for archives,
// where OpenImageIO would bring two hundred libraries (tools/bundle.sh). Its pixels equal OpenImageIO's: TIFF has 16
// bits, the others 8.
#include "io/display/oiio_module.h"

// clang-format off
#include <cstdio> // jpeglib.h needs it before
#include <jpeglib.h>
// clang-format on
#include <png.h>
#include <tiffio.h>

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace sparselens {

namespace {

constexpr int jpeg_quality = 98; // OpenImageIO's default

struct Closed {
    void operator()(std::FILE *file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Closed>;

File opened(const OiioPicture &picture) {
    File file(std::fopen(picture.path, "wb"));
    if (!file) throw std::runtime_error("the file cannot be opened");
    return file;
}

void flush(const File &file) {
    if (std::fflush(file.get()) != 0) throw std::runtime_error("the file cannot be written to its end");
}

// Rows as integers, rounded as OpenImageIO does; NaN becomes 0.
template <class Integer>
class Rows {
public:
    explicit Rows(const OiioPicture &picture)
        : picture_(picture), row_(std::size_t(picture.width) * std::size_t(picture.channels)) {}

    Integer *operator()(int y) {
        static constexpr float most = float(Integer(-1));
        const float *values = picture_.row(picture_.source, y);
        std::transform(values, values + row_.size(), row_.begin(), [](float value) {
            const float scaled = value * most + 0.5f;
            return scaled >= 0 ? Integer(std::min(scaled, most)) : Integer(0);
        });
        return row_.data();
    }

private:
    const OiioPicture &picture_;
    std::vector<Integer> row_;
};

// The densities across and down of pixels with this aspect, width over height.
struct Density {
    explicit Density(float pixel_aspect) : down(unsigned(std::lround(100 * pixel_aspect))) {}
    unsigned across = 100, down;
};

// libpng and libjpeg report an error by a function that must not return.
[[noreturn]] void png_failed(png_structp, png_const_charp why) { throw std::runtime_error(why); }
void png_warned(png_structp, png_const_charp) {}

void write_png(const OiioPicture &picture) {
    struct Writer {
        png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, png_failed, png_warned);
        png_infop info = png_create_info_struct(png);
        ~Writer() { png_destroy_write_struct(&png, &info); }
    } writer;
    const File file = opened(picture);
    const Density density(picture.pixel_aspect);
    png_init_io(writer.png, file.get());
    png_set_IHDR(writer.png, writer.info, png_uint_32(picture.width), png_uint_32(picture.height), 8,
                 picture.channels == 4 ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_pHYs(writer.png, writer.info, density.across, density.down, PNG_RESOLUTION_UNKNOWN);
    png_write_info(writer.png, writer.info);
    Rows<std::uint8_t> rows(picture);
    for (int y = 0; y < picture.height; ++y) png_write_row(writer.png, rows(y));
    png_write_end(writer.png, nullptr);
    flush(file);
}

[[noreturn]] void jpeg_failed(j_common_ptr jpeg) {
    char why[JMSG_LENGTH_MAX];
    jpeg->err->format_message(jpeg, why);
    throw std::runtime_error(why);
}

void write_jpeg(const OiioPicture &picture) {
    struct Writer {
        jpeg_compress_struct jpeg = {};
        jpeg_error_mgr errors = {};
        Writer() {
            jpeg.err = jpeg_std_error(&errors);
            errors.error_exit = jpeg_failed;
            jpeg_create_compress(&jpeg);
        }
        ~Writer() { jpeg_destroy_compress(&jpeg); }
    } writer;
    jpeg_compress_struct &jpeg = writer.jpeg;
    const File file = opened(picture);
    const Density density(picture.pixel_aspect);
    jpeg_stdio_dest(&jpeg, file.get());
    jpeg.image_width = JDIMENSION(picture.width);
    jpeg.image_height = JDIMENSION(picture.height);
    jpeg.input_components = 3;
    jpeg.in_color_space = JCS_RGB;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, jpeg_quality, TRUE);
    jpeg.X_density = UINT16(density.across);
    jpeg.Y_density = UINT16(density.down);
    jpeg_start_compress(&jpeg, TRUE);
    Rows<std::uint8_t> rows(picture);
    for (int y = 0; y < picture.height; ++y) {
        JSAMPROW row = rows(y);
        jpeg_write_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_compress(&jpeg);
    flush(file);
}

int tiff_failed(TIFF *, void *why, const char *, const char *format, std::va_list words) {
    char text[256];
    std::vsnprintf(text, sizeof text, format, words);
    *static_cast<std::string *>(why) = text;
    return 1;
}

void write_tiff(const OiioPicture &picture) {
    std::string why = "the file cannot be written";
    TIFFOpenOptions *options = TIFFOpenOptionsAlloc();
    TIFFOpenOptionsSetErrorHandlerExtR(options, tiff_failed, &why);
    const std::unique_ptr<TIFF, void (*)(TIFF *)> file(TIFFOpenExt(picture.path, "w", options), TIFFClose);
    TIFFOpenOptionsFree(options);
    if (!file) throw std::runtime_error(why);
    TIFF *tiff = file.get();
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, picture.width);
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, picture.height);
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, picture.channels);
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 16);
    TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_RGB);
    TIFFSetField(tiff, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
    TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE);
    TIFFSetField(tiff, TIFFTAG_PREDICTOR, PREDICTOR_HORIZONTAL);
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 32);
    TIFFSetField(tiff, TIFFTAG_RESOLUTIONUNIT, RESUNIT_NONE);
    TIFFSetField(tiff, TIFFTAG_XRESOLUTION, 1.0);
    TIFFSetField(tiff, TIFFTAG_YRESOLUTION, double(picture.pixel_aspect));
    const std::uint16_t alpha = EXTRASAMPLE_UNASSALPHA;
    if (picture.channels == 4) TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, 1, &alpha);
    Rows<std::uint16_t> rows(picture);
    for (int y = 0; y < picture.height; ++y)
        if (TIFFWriteScanline(tiff, rows(y), std::uint32_t(y), 0) < 0) throw std::runtime_error(why);
    if (TIFFFlush(tiff) == 0) throw std::runtime_error(why);
}

OiioModule::Support support(const char *extension) {
    const std::string format = extension;
    if (format == "png" || format == "tif" || format == "tiff") return OiioModule::Support::alpha;
    return format == "jpg" || format == "jpeg" ? OiioModule::Support::opaque : OiioModule::Support::none;
}

const char *write(const OiioPicture &picture) {
    thread_local std::string why;
    const std::string format = picture.format;
    try {
        (format == "png" ? write_png : format.starts_with("tif") ? write_tiff : write_jpeg)(picture);
        return nullptr;
    } catch (const std::exception &error) {
        why = error.what();
    }
    return why.c_str();
}

} // namespace

extern "C" OiioModule sparselens_oiio_module() { return {support, write}; }

} // namespace sparselens
