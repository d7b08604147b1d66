#include "io/display/oiio_module.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <string>
#include <vector>

namespace sparselens {

namespace {

OiioModule::Support support(const char *extension) {
    const auto file = OIIO::ImageOutput::create(extension);
    if (!file) return OiioModule::Support::none;
    // The WebP writer divides colours by alpha once more, whatever the attribute below says.
    return file->supports("alpha") && extension != std::string("webp") ? OiioModule::Support::alpha
                                                                       : OiioModule::Support::opaque;
}

bool written(OIIO::ImageOutput &file, const OiioPicture &picture) {
    OIIO::ImageSpec spec(picture.width, picture.height, picture.channels,
                         picture.bits == 16 ? OIIO::TypeDesc::UINT16 : OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    spec.attribute("PixelAspectRatio", picture.pixel_aspect);
    OIIO::Filesystem::IOVecOutput memory;
    if (file.supports("ioproxy")) file.set_ioproxy(&memory);
    if (!file.open(picture.path, spec)) return false;
    for (int y = 0; y < picture.height; ++y)
        if (!file.write_scanline(y, 0, OIIO::TypeDesc::FLOAT, picture.row(picture.source, y))) return false;
    if (!file.close()) return false;
    picture.put(picture.bytes, memory.buffer().data(), memory.size());
    return true;
}

const char *write(const OiioPicture &picture) {
    thread_local std::string why;
    const auto file = OIIO::ImageOutput::create(picture.format);
    // libjpeg would end the process.
    if (file && file->format_name() == std::string("jpeg") && std::max(picture.width, picture.height) > 65500)
        return "a JPEG has at most 65500 pixels on a side";
    if (file && written(*file, picture)) return nullptr;
    why = file ? file->geterror() : OIIO::geterror();
    return why.c_str();
}

// Turns a plane of the file as its attribute Orientation says.
void turn(float *plane, const OIIO::ImageSpec &spec, int orientation) {
    const std::vector<float> stored(plane, plane + std::ptrdiff_t(spec.width) * spec.height);
    const float *from = stored.data();
    for (int y = 0; y < spec.height; ++y)
        for (int x = 0; x < spec.width; ++x)
            plane[upright(x, y, spec.width, spec.height, orientation)] = *from++;
}

const char *read(const char *path, OiioSize &size, float *values) {
    thread_local std::string why;
    const auto file = OIIO::ImageInput::open(path);
    if (!file) return (why = OIIO::geterror()).c_str();
    const OIIO::ImageSpec &spec = file->spec();
    const int turned = spec.get_int_attribute("Orientation", 1);
    const bool on_side = turned > 4; // rows and columns change places
    const int width = on_side ? spec.height : spec.width, height = on_side ? spec.width : spec.height;
    const bool floats = spec.format.is_floating_point();
    if (!values) size = {width, height, spec.get_float_attribute("PixelAspectRatio", 1), floats};
    if (width != size.width || height != size.height) return "it has changed";
    const bool is_grey = spec.nchannels < 3;
    for (int k = 0; values && k < 3; ++k) {
        const int from = is_grey ? 0 : k;
        float *plane = values + std::ptrdiff_t(k) * size.width * size.height;
        if (!file->read_image(0, 0, from, from + 1, OIIO::TypeDesc::FLOAT, plane))
            return (why = file->geterror()).c_str();
        if (turned > 1) turn(plane, spec, turned);
    }
    return nullptr;
}

} // namespace

extern "C" OiioModule sparselens_oiio_module() { return {support, write, read}; }

} // namespace sparselens
