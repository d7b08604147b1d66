// Writes PNG, and reads PNG and JPEG, by libpng and libjpeg alone: the module of io/display/oiio_module.h for archives,
// where OpenImageIO would bring two hundred libraries (tools/bundle.sh). Its pixels equal those of the other module.
#include "io/display/heif.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string_view>

namespace sparselens {

namespace {

OiioModule::Support support(const char *extension) {
    return extension == std::string_view("png") ? OiioModule::Support::alpha : OiioModule::Support::none;
}

bool reads(const char *extension) {
    constexpr std::array<std::string_view, 3> endings{"png", "jpg", "jpeg"};
    return std::ranges::find(endings, extension) != endings.end() || heif::has_ending(extension);
}

const char *write(const OiioPicture &picture) {
    return failure_of([&] { png::write(picture); });
}

const char *read(const char *path, OiioFile &file, float *values) {
    return failure_of([&] {
        read_into(file, values, [&](PictureFile &to) {
            if (!heif::read(path, to) && !to.before.own_depth && !read_png_or_jpeg(path, to))
                throw std::runtime_error(
                    "this archive reads PNG, JPEG and HEIC: convert it (oiiotool IN -o OUT.png)");
        });
    });
}

} // namespace

extern "C" OiioModule sparselens_oiio_module() { return {support, reads, write, read}; }

} // namespace sparselens
