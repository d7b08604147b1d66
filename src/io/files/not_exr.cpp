#include "io/files/not_exr.h"

#include <fmt/format.h>

#include <array>

namespace sparselens {

namespace {

using namespace std::string_view_literals;

struct Format {
    std::string_view begins, name;
};
constexpr std::array<Format, 8> formats{{{"\x89PNG"sv, "a PNG"},
                                         {"\xff\xd8\xff"sv, "a JPEG"},
                                         {"II*\0"sv, "a TIFF"},
                                         {"MM\0*"sv, "a TIFF"},
                                         {"SDPX"sv, "a DPX"},
                                         {"XPDS"sv, "a DPX"},
                                         {"#?RADIANCE"sv, "a Radiance"},
                                         {"#?RGBE"sv, "a Radiance"}}};

} // namespace

std::string not_exr(std::string_view first_bytes) {
    for (const Format &format : formats)
        if (first_bytes.starts_with(format.begins))
            return fmt::format(
                "is {} picture, and EXR is needed: render to EXR, with depth, or convert what needs "
                "no depth (oiiotool IN -o OUT.exr)",
                format.name);
    return "not an EXR file";
}

} // namespace sparselens
