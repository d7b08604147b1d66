#include "io/shown_picture.h"

#include "base/error.h"
#include "io/file_stream.h"
#include "io/oiio_module.h"
#include "io/unfinished.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <vector>

namespace sparselens {

namespace {

// Without the dot, in lower case.
std::string extension_of(const std::string &path) {
    std::string extension = std::filesystem::path(path).extension().string();
    for (char &c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
    return extension.empty() ? extension : extension.substr(1);
}

// Pixels of the display window, channel by channel within each.
std::vector<float> interleaved(const Image &image, const std::vector<std::size_t> &channels, bool divide) {
    const Windows &w = image.windows;
    const Imath::Box2i &display = w.display;
    const std::size_t width = std::size_t(w.display_width()), count = channels.size();
    std::vector<float> pixels(width * std::size_t(w.display_height()) * count);
    const Imath::V2i first(std::max(display.min.x, w.data.min.x), std::max(display.min.y, w.data.min.y));
    const Imath::V2i last(std::min(display.max.x, w.data.max.x), std::min(display.max.y, w.data.max.y));
    for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) {
            float *pixel =
                &pixels[(std::size_t(y - display.min.y) * width + std::size_t(x - display.min.x)) * count];
            const float a = divide ? image.at(channels.back(), x, y) : 1;
            for (std::size_t k = 0; k < count; ++k)
                pixel[k] = image.at(channels[k], x, y) / (k < 3 && a > 0 ? a : 1);
        }
    return pixels;
}

// OpenImageIO writes to names, and by no means all of its formats to a stream: to a file of its own, then.
class TemporaryFile {
public:
    explicit TemporaryFile(const std::string &extension)
        : unfinished_((std::filesystem::temp_directory_path() /
                       ("sparselens." + std::to_string(::getpid()) + "." + extension))
                          .string()) {}
    ~TemporaryFile() { ::unlink(path().c_str()); }
    TemporaryFile(const TemporaryFile &) = delete;
    TemporaryFile &operator=(const TemporaryFile &) = delete;
    const std::string &path() const { return unfinished_.path(); }

private:
    Unfinished unfinished_;
};

void copy_to(const std::string &path, const std::string &from) {
    std::ifstream in(from, std::ios::binary);
    const std::string bytes(std::istreambuf_iterator<char>(in), {});
    OutputFile output(path);
    output.stream().write(bytes.data(), int(bytes.size()));
    output.commit();
}

} // namespace

bool is_shown_picture(const std::string &path) {
    const std::string extension = extension_of(path);
    if (extension.empty() || extension == "exr") return false;
    return oiio_module().support(extension.c_str()) != OiioModule::Support::none;
}

void write_shown_picture(const std::string &path, const Image &image) {
    std::vector<std::size_t> channels;
    for (const char *name : {"R", "G", "B"}) channels.push_back(find_channel(image.channels, name));
    if (std::ranges::find(channels, npos) != channels.end())
        throw Error(path + ": needs the channels R, G and B; other channels are for OpenEXR");
    const std::string extension = extension_of(path);
    const OiioModule &oiio = oiio_module();
    const std::size_t alpha = find_channel(image.channels, "A");
    const bool with_alpha = alpha != npos && oiio.support(extension.c_str()) == OiioModule::Support::alpha &&
                            std::ranges::any_of(image.plane(alpha), [](float a) { return a < 1; });
    if (with_alpha) channels.push_back(alpha);
    const std::vector<float> pixels = interleaved(image, channels, with_alpha);
    const bool deep_bits = extension.starts_with("tif") || extension == "dpx";
    const TemporaryFile temporary(extension);
    const char *failed = oiio.write({temporary.path().c_str(), pixels.data(), image.windows.display_width(),
                                     image.windows.display_height(), int(channels.size()), deep_bits ? 16 : 8,
                                     image.windows.pixel_aspect});
    if (failed) throw Error(path + ": cannot write: " + failed);
    copy_to(path, temporary.path());
}

} // namespace sparselens
