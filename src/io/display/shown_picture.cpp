#include "io/display/shown_picture.h"

#include "base/error.h"
#include "base/text.h"
#include "io/display/oiio_module.h"
#include "io/files/file_stream.h"
#include "io/files/memory_limit.h"
#include "io/files/text_file.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>
#include <system_error>
#include <vector>

namespace sparselens {

namespace {

// When installed, and in the build folder, programs lie in bin/ and modules in lib/ beside it.
std::string beside_program(const std::string &module) {
    std::error_code unknown;
    const auto program = std::filesystem::read_symlink("/proc/self/exe", unknown);
    return (program.parent_path().parent_path() / SPARSELENS_MODULES / module).string();
}

// A program that loads this code from a library or a module may lie anywhere; modules then lie in lib/ of a folder
// above that library. Empty if there is none.
std::string above_this_code(const std::string &module) {
    Dl_info found;
    std::error_code unknown;
    if (::dladdr(reinterpret_cast<const void *>(&above_this_code), &found) == 0) return {};
    const auto library = std::filesystem::weakly_canonical(found.dli_fname, unknown);
    for (auto folder = library.parent_path(); folder != folder.parent_path(); folder = folder.parent_path())
        if (const auto path = folder / SPARSELENS_MODULES / module; std::filesystem::exists(path, unknown))
            return path.string();
    return {};
}

OiioModule load() {
    const std::string name = SPARSELENS_OIIO_MODULE;
    void *module = nullptr;
    for (const std::string &path :
         {beside_program(name), above_this_code(name), SPARSELENS_PREFIX "/" SPARSELENS_MODULES "/" + name})
        if (!module && !path.empty()) module = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    void *entry = module ? ::dlsym(module, oiio_module_entry) : nullptr;
    if (!entry)
        throw Error(std::string("cannot load OpenImageIO, which writes PNG, JPEG and TIFF: ") + ::dlerror());
    return reinterpret_cast<OiioModule (*)()>(entry)();
}

// Throws Error if the module is not found or cannot be loaded.
const OiioModule &oiio_module() {
    static const OiioModule module = load(); // stays loaded
    return module;
}

// The extension without the dot, in lower case.
std::string extension_of(const std::string &path) {
    const std::string extension = lower_case(std::filesystem::path(path).extension().string());
    return extension.empty() ? extension : extension.substr(1);
}

// Makes rows of the display window one at a time, because it may be much larger than the picture in it.
class DisplayRows {
public:
    DisplayRows(const Image &image, std::vector<std::size_t> channels, bool divide)
        : image_(image), channels_(std::move(channels)), divide_(divide),
          row_(std::size_t(image.windows.display_width()) * channels_.size()) {}

    const float *row(int y) {
        std::ranges::fill(row_, 0.0f);
        const Imath::Box2i &display = image_.windows.display, &data = image_.windows.data;
        const int row = display.min.y + y;
        if (row < data.min.y || row > data.max.y) return row_.data();
        for (int x = std::max(display.min.x, data.min.x); x <= std::min(display.max.x, data.max.x); ++x) {
            float *pixel = &row_[std::size_t(x - display.min.x) * channels_.size()];
            const float a = divide_ ? image_.at(channels_.back(), x, row) : 1;
            for (std::size_t k = 0; k < channels_.size(); ++k)
                pixel[k] = image_.at(channels_[k], x, row) / (k < 3 && a > 0 ? a : 1);
        }
        return row_.data();
    }

private:
    const Image &image_;
    std::vector<std::size_t> channels_;
    bool divide_; // by the last channel, the coverage
    std::vector<float> row_;
};

const float *row_of(void *rows, int y) { return static_cast<DisplayRows *>(rows)->row(y); }

// R, G and B, and A if it is below 1 anywhere.
std::vector<std::size_t> channels_of(const std::string &name, const Image &image, bool may_have_alpha) {
    const auto rgb = find_rgb(image.channels);
    if (!all_found(rgb))
        throw Error(name + ": needs the channels R, G and B: write other channels to an EXR file");
    std::vector<std::size_t> channels(rgb.begin(), rgb.end());
    const std::size_t alpha = find_channel(image.channels, "A");
    if (alpha != npos && may_have_alpha &&
        std::ranges::any_of(image.plane(alpha), [](float a) { return a < 1; }))
        channels.push_back(alpha);
    return channels;
}

// Checks the size of the display window, which may be much larger than the picture in it.
void check_size(const std::string &name, const Image &image) {
    const Imath::Box2i &display = image.windows.display; // written as a whole
    check_memory(
        name, 3.0 * (double(display.max.x) - display.min.x + 1) * (double(display.max.y) - display.min.y + 1),
        image.values.size() * sizeof(float));
}

} // namespace

bool is_shown_picture(const std::string &path) {
    const std::string extension = extension_of(path);
    if (extension.empty() || extension == "exr") return false;
    return oiio_module().support(extension.c_str()) != OiioModule::Support::none;
}

ShownPixels shown_pixels(const std::string &name, const Image &image) {
    const std::vector<std::size_t> channels = channels_of(name, image, true);
    check_size(name, image);
    ShownPixels out{image.windows.display_width(), image.windows.display_height(), int(channels.size()), {}};
    const std::size_t in_row = std::size_t(out.width) * channels.size();
    out.values.reserve(in_row * std::size_t(out.height));
    DisplayRows rows(image, channels, channels.size() > 3);
    for (int y = 0; y < out.height; ++y) {
        const float *row = rows.row(y);
        std::transform(row, row + in_row, std::back_inserter(out.values), in_8_bits);
    }
    return out;
}

std::string shown_picture(const std::string &name, const std::string &format, const Image &image) {
    const OiioModule &oiio = oiio_module();
    const std::vector<std::size_t> channels =
        channels_of(name, image, oiio.support(format.c_str()) == OiioModule::Support::alpha);
    check_size(name, image);
    DisplayRows rows(image, channels, channels.size() > 3);
    const bool deep_bits = format.starts_with("tif") || format == "dpx";
    const MemoryFile encoded; // OpenImageIO writes all formats to a file but only some of them to a stream
    const char *failed = oiio.write({encoded.path().c_str(), format.c_str(), &rows, row_of,
                                     image.windows.display_width(), image.windows.display_height(),
                                     int(channels.size()), deep_bits ? 16 : 8, image.windows.pixel_aspect});
    if (failed) throw Error(name + ": cannot write: " + failed);
    return read_bytes(encoded.path());
}

void write_shown_picture(const std::string &path, const Image &image) {
    write_text_file(path, shown_picture(path, extension_of(path), image));
}

namespace {

bool is_pipe_or_device(const std::string &path) {
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    return path.starts_with("/dev/") ||
           (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status) &&
            !std::filesystem::is_directory(status));
}

// The usual endings that the installed OpenImageIO writes.
std::string endings() {
    static constexpr std::array usual{"png", "jpg", "jpeg", "tif", "tiff",
                                      "bmp", "dpx", "hdr",  "tga", "webp"};
    std::string list = ".exr";
    for (const char *ending : usual)
        if (is_shown_picture(std::string("x.") + ending)) list += fmt::format(", .{}", ending);
    return list;
}

} // namespace

std::string wrong_with_output(const std::string &path, OutputKind kind) {
    const std::string ending = lower_case(std::filesystem::path(path).extension().string());
    if (is_standard_stream(path) || ending == ".exr" || is_pipe_or_device(path)) return {};
    if (kind == OutputKind::exr)
        return fmt::format("{} does not end in .exr, which is what is written", path);
    if (is_shown_picture(path)) return {};
    return fmt::format("{} ends in no format that is written: {}", path, endings());
}

} // namespace sparselens
