#include "io/output_name.h"

#include "base/text.h"
#include "io/display/shown_picture.h"
#include "io/files/file_stream.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <system_error>

namespace sparselens {

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
