#include "io/display/oiio_module.h"

#include "io/display/heif.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <array>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

// Declared in tiffutils.h, which needs the headers of libtiff.
OIIO_NAMESPACE_BEGIN
OIIO_API bool decode_exif(string_view exif, ImageSpec &spec);
OIIO_API void encode_exif(const ImageSpec &spec, std::vector<char> &blob, endian order);
OIIO_NAMESPACE_END

namespace sparselens {

namespace {

OiioModule::Support support(const char *extension) {
    const auto file = OIIO::ImageOutput::create(extension);
    if (!file) return OiioModule::Support::none;
    // The WebP writer divides colours by alpha once more, whatever the attribute below says.
    return file->supports("alpha") && extension != std::string("webp") ? OiioModule::Support::alpha
                                                                       : OiioModule::Support::opaque;
}

bool reads(const char *extension) {
    if (heif::has_ending(extension)) return true;
    constexpr std::array<std::string_view, 4> no_pictures{"openexr", "FFmpeg movie", "null", "openvdb"};
    const auto file = OIIO::ImageInput::create(extension);
    return file && std::ranges::find(no_pictures, file->format_name()) == no_pictures.end();
}

OIIO::TypeDesc bytes_type(const OiioBytes &of) { return {OIIO::TypeDesc::UINT8, int(of.size)}; }

// Writes the Exif that the picture comes with, upright.
void add_exif(OIIO::ImageSpec &spec, const OiioBytes &exif) {
    if (exif.size == 0) return;
    OIIO::decode_exif({static_cast<const char *>(exif.bytes), exif.size}, spec);
    spec.erase_attribute("oiio:ColorSpace");
    spec.attribute("Orientation", 1);
    for (const auto &[name, size] : {std::pair("X", spec.width), std::pair("Y", spec.height)})
        spec.attribute(std::string("Exif:Pixel") + name + "Dimension", size);
}

bool written(OIIO::ImageOutput &file, const OiioPicture &picture) {
    OIIO::ImageSpec spec(picture.width, picture.height, picture.channels,
                         picture.bits == 16 ? OIIO::TypeDesc::UINT16 : OIIO::TypeDesc::UINT8);
    add_exif(spec, picture.exif);
    if (picture.profile.size > 0)
        spec.attribute("ICCProfile", bytes_type(picture.profile), picture.profile.bytes);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    spec.attribute("PixelAspectRatio", picture.pixel_aspect);
    OIIO::Filesystem::IOVecOutput memory;
    const bool to_file =
        picture.exif.size > 0 && file.format_name() == std::string("tiff"); // it reads what it wrote
    if (file.supports("ioproxy") && !to_file) file.set_ioproxy(&memory);
    if (!file.open(picture.path, spec)) return false;
    for (int y = 0; y < picture.height; ++y)
        if (!file.write_scanline(y, 0, OIIO::TypeDesc::FLOAT, picture.row(picture.source, y))) return false;
    if (!file.close()) return false;
    picture.put(picture.bytes, memory.buffer().data(), memory.size());
    return true;
}

const char *write(const OiioPicture &picture) {
    // OpenImageIO writes Exif to PNG as texts.
    if (picture.exif.size + picture.profile.size > 0 && picture.format == std::string("png"))
        return failure_of([&] { png::write(picture); });
    thread_local std::string why;
    const auto file = OIIO::ImageOutput::create(picture.format);
    // libjpeg would end the process.
    if (file && file->format_name() == std::string("jpeg") && std::max(picture.width, picture.height) > 65500)
        return "a JPEG has at most 65500 pixels on a side";
    if (file && written(*file, picture)) return nullptr;
    why = file ? file->geterror() : OIIO::geterror();
    return why.c_str();
}

// OpenImageIO passes neither Exif nor the profile of WebP on.
void describe_webp(const char *path, PictureFile &to) {
    const FilePointer file = opened(path);
    to.exif = chunk_of(file.get(), "EXIF", true);
    to.profile = chunk_of(file.get(), "ICCP", true);
    to.said.orientation = take_orientation(to.exif);
}

// Returns whether the colours are multiplied by alpha.
bool describe(const OIIO::ImageInput &file, const char *path, PictureFile &to) {
    OIIO::ImageSpec spec = file.spec();
    to.said.orientation = spec.get_int_attribute("Orientation", 1);
    if (const OIIO::ParamValue *profile = spec.find_attribute("ICCProfile"))
        to.profile.assign(static_cast<const char *>(profile->data()), profile->type().size());
    spec.erase_attribute("Orientation");
    std::vector<char> exif;
    if (spec.find_attribute("Make") || spec.find_attribute("DateTime") || spec.find_attribute("Artist") ||
        spec.find_attribute("Copyright") || spec.find_attribute("Exif:DateTimeOriginal"))
        OIIO::encode_exif(spec, exif, OIIO::endian::little);
    to.exif.assign(exif.begin(), exif.end());
    if (file.format_name() == std::string("webp")) describe_webp(path, to);
    to.set_stored_size(spec.width, spec.height);
    to.said.pixel_aspect = spec.get_float_attribute("PixelAspectRatio", 1);
    to.said.bits = spec.format.is_floating_point() ? 32 : spec.format.size() > 1 ? 16 : 8;
    to.said.alpha = spec.alpha_channel == (spec.nchannels < 3 ? 1 : 3);
    return to.said.alpha && spec.get_int_attribute("oiio:UnassociatedAlpha") == 0;
}

void divide(std::vector<float> &pixels, int channels) {
    const std::size_t step = std::size_t(channels), a = channels < 3 ? 1 : 3;
    for (std::size_t at = 0; at < pixels.size(); at += step)
        for (std::size_t k = 0; k < a; ++k)
            if (pixels[at + a] > 0) pixels[at + k] /= pixels[at + a];
}

// All channels at once: some files come out wrong one channel after the other.
void read_pixels(OIIO::ImageInput &file, bool multiplied, const PictureFile &to) {
    const OIIO::ImageSpec &spec = file.spec();
    const int rows = spec.tile_width > 0 ? spec.tile_height : 64, channels = spec.nchannels;
    std::vector<float> pixels(std::size_t(spec.width) * std::size_t(rows) * std::size_t(channels));
    for (int y = 0; y < spec.height; y += rows) {
        const int from = spec.y + y, end = spec.y + std::min(y + rows, spec.height);
        const bool done = spec.tile_width > 0
                              ? file.read_tiles(0, 0, spec.x, spec.x + spec.width, from, end, spec.z,
                                                spec.z + 1, 0, channels, OIIO::TypeDesc::FLOAT, pixels.data())
                              : file.read_scanlines(0, 0, from, end, spec.z, 0, channels,
                                                    OIIO::TypeDesc::FLOAT, pixels.data());
        if (!done) throw std::runtime_error(file.geterror());
        if (multiplied) divide(pixels, channels);
        for (int row = from; row < end; ++row)
            to.put_row(row - spec.y,
                       &pixels[std::size_t(row - from) * std::size_t(spec.width) * std::size_t(channels)],
                       channels);
    }
}

const char *read(const char *path, OiioFile &file, float *values) {
    return failure_of([&] {
        read_into(file, values, [&](PictureFile &to) {
            if (heif::read(path, to) || to.before.own_depth || read_png_or_jpeg(path, to)) return;
            OIIO::ImageSpec as_stored;
            as_stored.attribute("oiio:UnassociatedAlpha", 1);
            const auto picture = OIIO::ImageInput::open(path, &as_stored);
            if (!picture) throw std::runtime_error(OIIO::geterror());
            const bool multiplied = describe(*picture, path, to);
            if (to.wants_pixels()) read_pixels(*picture, multiplied, to);
        });
    });
}

} // namespace

extern "C" OiioModule sparselens_oiio_module() { return {support, reads, write, read}; }

} // namespace sparselens
