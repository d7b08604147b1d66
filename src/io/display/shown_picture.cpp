#include "io/display/shown_picture.h"

#include "base/error.h"
#include "base/system/system.h"
#include "base/text.h"
#include "io/display/oiio_module.h"
#include "io/files/file_stream.h"
#include "io/files/memory_limit.h"
#include "io/files/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <iterator>
#include <system_error>

namespace sparselens {

namespace {

OiioModule load() {
    const std::string path = find_installed(SPARSELENS_MODULES "/" SPARSELENS_OIIO_MODULE);
    void *module = path.empty() ? nullptr : system::load_library(path);
    void *entry = module ? system::function_of(module, oiio_module_entry) : nullptr;
    if (!entry)
        throw Error(std::string("cannot load OpenImageIO, which writes and reads PNG, JPEG and TIFF: ") +
                    (path.empty() ? SPARSELENS_OIIO_MODULE " is not installed" : system::loading_error()));
    return reinterpret_cast<OiioModule (*)()>(entry)();
}

// Throws Error if the module is not found or cannot be loaded.
const OiioModule &oiio_module() {
    static const OiioModule module = load(); // stays loaded
    return module;
}

constexpr std::array usual{".png", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp", ".dpx", ".hdr", ".tga", ".webp"};

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
void append(void *bytes, const void *piece, std::size_t count) {
    static_cast<std::string *>(bytes)->append(static_cast<const char *>(piece), count);
}

bool is_open(const Image &image, std::size_t alpha) {
    return std::ranges::any_of(image.plane(alpha), [](float a) { return a < 1; });
}

// R, G and B, and A if it is below 1 anywhere.
std::vector<std::size_t> channels_of(const std::string &name, const Image &image, bool may_have_alpha) {
    const auto rgb = find_rgb(image.channels);
    if (!all_found(rgb))
        throw Error(name + ": needs the channels R, G and B: write other channels to an EXR file");
    std::vector<std::size_t> channels(rgb.begin(), rgb.end());
    const std::size_t alpha = find_channel(image.channels, "A");
    if (alpha != npos && may_have_alpha && is_open(image, alpha)) channels.push_back(alpha);
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

bool holds_linear_light(const std::string &path) {
    static constexpr std::array formats{"hdr", "rgbe", "pfm"};
    return is_among(formats, extension_of(path));
}

bool drop_unwritten_coverage(const std::string &path, Image &image) {
    const std::size_t alpha = find_channel(image.channels, "A");
    if (alpha == npos || oiio_module().support(extension_of(path).c_str()) == OiioModule::Support::alpha)
        return false;
    const bool open = is_open(image, alpha);
    const auto plane = image.values.begin() + std::ptrdiff_t(alpha * image.windows.pixels());
    image.values.erase(plane, plane + std::ptrdiff_t(image.windows.pixels()));
    image.channels.erase(image.channels.begin() + std::ptrdiff_t(alpha));
    return open;
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

std::string shown_picture(const std::string &name, const std::string &format, const Image &image,
                          const ShownExtras &extras) {
    const OiioModule &oiio = oiio_module();
    const std::vector<std::size_t> channels =
        channels_of(name, image, oiio.support(format.c_str()) == OiioModule::Support::alpha);
    check_size(name, image);
    DisplayRows rows(image, channels, channels.size() > 3);
    const bool deep_bits = format.starts_with("tif") || format == "dpx" || extras.bits == 16;
    const auto bytes_of = [](const std::string &of) { return OiioBytes{of.data(), of.size()}; };
    const MemoryFile file;
    std::string bytes;
    const char *failed = oiio.write({format.c_str(), file.path().c_str(), &rows, row_of,
                                     image.windows.display_width(), image.windows.display_height(),
                                     int(channels.size()), deep_bits ? 16 : 8, image.windows.pixel_aspect,
                                     bytes_of(extras.profile), bytes_of(extras.exif), append, &bytes});
    if (failed) throw Error(name + ": cannot write: " + failed);
    if (!bytes.empty()) return bytes;
    // The library may not notice that its file is cut off. A picture may take up to twice its bytes.
    const std::size_t largest = 65536 + 4 * channels.size() * std::size_t(image.windows.display_width()) *
                                            std::size_t(image.windows.display_height());
    if (!file.can_hold(largest)) fail_of_system(name, "cannot write");
    return read_bytes(file.path());
}

void write_shown_picture(const std::string &path, const Image &image, const ShownExtras &extras) {
    write_text_file(path, shown_picture(path, extension_of(path), image, extras));
}

bool has_shown_ending(const std::string &path) {
    const std::string extension = extension_of(path);
    if (extension.empty() || extension == "exr") return false;
    return extension == "pfm" ||
           std::ranges::any_of(usual, [&](const char *ending) { return ending + 1 == extension; }) ||
           oiio_module().reads(extension.c_str());
}

namespace {

// Multiplies the colours by A, or drops A if it says nothing or is not wanted.
void settle_alpha(Image &image, bool without) {
    const std::size_t alpha = find_channel(image.channels, "A");
    if (alpha == npos) return;
    if (!without && is_open(image, alpha))
        for (std::size_t k = 0; k < 3; ++k)
            std::ranges::transform(image.plane(k), image.plane(alpha), image.plane(k).begin(),
                                   std::multiplies());
    else
        image.channels.pop_back(), image.values.resize(3 * image.windows.pixels());
}

} // namespace

ShownFile read_shown_picture(const std::string &path, ShownPart part) {
    if (is_read_once(path)) throw Error(path + ": cannot read: not a regular file: store the picture in one");
    OiioFile said{};
    const auto read = [&](float *to) {
        said.own_depth = part == ShownPart::own_depth;
        if (const char *failed = oiio_module().read(path.c_str(), said, to))
            throw Error(path + ": cannot read: " + failed);
    };
    read(nullptr);
    if (said.width == 0) return {};
    // A flat picture of a few bytes may be large: 1.1 GB are no danger.
    constexpr std::uint64_t harmless = 1'000'000; // bytes of a file
    check_memory(path, (said.alpha ? 16.0 : 12.0) * said.width * said.height,
                 std::max<std::uint64_t>(std::filesystem::file_size(path), harmless));
    ShownFile file{
        Image(windows_of_size(said.width, said.height), {{"R"}, {"G"}, {"B"}}), {}, said.orientation};
    if (said.alpha) file.image = Image(file.image.windows, rgba_channels());
    file.image.windows.pixel_aspect = said.pixel_aspect;
    read(file.image.values.data());
    const auto text_of = [](const OiioBytes &of) {
        return of.size > 0 ? std::string(static_cast<const char *>(of.bytes), of.size) : std::string();
    };
    file.extras = {said.bits, text_of(said.profile), text_of(said.exif)};
    settle_alpha(file.image, part != ShownPart::picture);
    return file;
}

Image turned(const Image &plane, int orientation) {
    const int width = plane.windows.width(), height = plane.windows.height();
    Image result(orientation > 4 ? windows_of_size(height, width) : windows_of_size(width, height),
                 plane.channels);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            result.values[upright(x, y, width, height, orientation)] = plane.at(0, x, y);
    return result;
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
    std::string list = ".exr";
    for (const char *ending : usual)
        if (is_shown_picture(std::string("x") + ending)) list += fmt::format(", {}", ending);
    return list;
}

} // namespace

std::string picture_formats() {
    return fmt::format("EXR, or through OpenImageIO {}", fmt::join(usual, ", "));
}

std::string wrong_with_output(const std::string &path, OutputKind kind) {
    const std::string ending = lower_case(std::filesystem::path(path).extension().string());
    if (is_standard_stream(path) || ending == ".exr" || is_pipe_or_device(path)) return {};
    if (kind == OutputKind::exr)
        return fmt::format("{} does not end in .exr, which is what is written", path);
    if (is_shown_picture(path)) return {};
    return fmt::format("{} ends in no format that is written: {}", path, endings());
}

} // namespace sparselens
