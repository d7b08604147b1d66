// HEIC and AVIF, with the depth that a phone puts beside their colours, for both modules of io/display/oiio_module.h.
// libheif is loaded for the first such file. Its interface in C, declared here, has been the same since version 1.12.
#pragma once

#include "base/system/system.h"
#include "io/display/png_jpeg.h"

namespace sparselens::heif {

// Calls a function of libheif. The arguments have the types of its parameters, and all its objects are void here.
template <typename Result, typename... Arguments>
Result call(const char *name, Arguments... arguments) {
    static void *const library = system::load_library("libheif.so.1");
    if (!library) throw std::runtime_error("HEIC and AVIF need libheif (sudo apt-get install libheif1)");
    void *const function = system::function_of(library, name);
    if (!function) throw std::runtime_error(std::string("HEIC and AVIF need a newer libheif, with ") + name);
    return reinterpret_cast<Result (*)(Arguments...)>(function)(arguments...);
}

struct Failure {
    int code, more;
    const char *why;
};
inline void check(const Failure &failure) {
    if (failure.code != 0) throw std::runtime_error(failure.why);
}

struct Release {
    const char *by; // a function
    void operator()(void *object) const { call<void>(by, object); }
};
using Owned = std::unique_ptr<void, Release>;
inline constexpr Release release_handle{"heif_image_handle_release"};

struct ColourCode { // the beginning of heif_color_profile_nclx
    std::uint8_t version;
    int primaries, transfer;
};
struct DepthInfo { // the beginning of heif_depth_representation_info
    std::uint8_t version;
    std::array<std::uint8_t, 4> given;
    std::array<double, 4> values;
    int type; // 0: inverse depth, 1: disparity, both white near
};

// Throws if colours without a profile are not those of a usual display (ITU-T H.273).
inline void check_colours(void *handle) {
    void *found = nullptr;
    if (call<Failure>("heif_image_handle_get_nclx_color_profile", handle, &found).code != 0) return;
    const Owned code(found, {"heif_nclx_color_profile_free"});
    const auto &colours = *static_cast<const ColourCode *>(found);
    const auto is = [](int value, auto... one) { return ((value == one) || ...); };
    if (!is(colours.primaries, 1, 2) || !is(colours.transfer, 1, 2, 6, 13, 14, 15))
        throw std::runtime_error(
            "its colours have no profile, and are not sRGB: convert it to a PNG of sRGB");
}

inline void describe(void *handle, PictureFile &to) {
    to.profile.resize(call<std::size_t>("heif_image_handle_get_raw_color_profile_size", handle));
    if (to.profile.empty())
        check_colours(handle);
    else
        check(call<Failure>("heif_image_handle_get_raw_color_profile", handle,
                            static_cast<void *>(to.profile.data())));
    std::uint32_t id = 0;
    if (call<int>("heif_image_handle_get_list_of_metadata_block_IDs", handle, "Exif", &id, 1) < 1) return;
    std::string exif(call<std::size_t>("heif_image_handle_get_metadata_size", handle, id), '\0');
    check(call<Failure>("heif_image_handle_get_metadata", handle, id, static_cast<void *>(exif.data())));
    std::size_t begin = 4; // behind it, a number tells where the Exif begins
    for (std::size_t i = 0, at = 0; i < 4 && i < exif.size(); ++i)
        at = at << 8 | std::uint8_t(exif[i]), begin = i == 3 ? at + 4 : begin;
    to.exif = exif.substr(std::min(begin, exif.size()));
    take_orientation(to.exif); // libheif turns the picture
}

// The depth of the picture; null if it has none.
inline Owned depth_of(void *handle) {
    std::uint32_t id = 0;
    void *depth = nullptr, *info = nullptr;
    if (call<int>("heif_image_handle_get_list_of_depth_image_IDs", handle, &id, 1) < 1)
        return {nullptr, release_handle};
    if (call<int>("heif_image_handle_get_depth_image_representation_info", handle, id, &info) != 0) {
        const Owned owned(info, {"heif_depth_representation_info_free"});
        if (const int type = static_cast<const DepthInfo *>(info)->type; type != 0 && type != 1)
            throw std::runtime_error("it is neither a disparity nor an inverse depth");
    }
    check(call<Failure>("heif_image_handle_get_depth_image_handle", handle, id, &depth));
    return {depth, release_handle};
}

inline void read_pixels(void *handle, const PictureFile &to) {
    const bool deep = to.said.bits > 8;
    const int channels = to.said.alpha ? 4 : 3, interleaved = 10, rgb = 1;
    const int chroma =
        (deep ? 14 : 10) + (to.said.alpha ? 1 : 0); // of 8 bits, or of 16 with the lower byte first
    void *decoded = nullptr;
    check(call<Failure>("heif_decode_image", handle, &decoded, rgb, chroma, static_cast<void *>(nullptr)));
    const Owned image(decoded, {"heif_image_release"});
    int stride = 0;
    const auto *rows =
        call<const std::uint8_t *>("heif_image_get_plane_readonly", decoded, interleaved, &stride);
    const int bits = deep ? call<int>("heif_image_get_bits_per_pixel_range", decoded, interleaved) : 8;
    const auto size = [&](const char *name) { return call<int>(name, decoded, interleaved); };
    if (!rows || size("heif_image_get_width") != to.said.width ||
        size("heif_image_get_height") != to.said.height)
        throw std::runtime_error("its size is not what it says");
    std::vector<float> row(std::size_t(to.said.width) * std::size_t(channels));
    for (int y = 0; y < to.said.height; ++y, rows += stride) {
        for (std::size_t n = 0; n < row.size(); ++n)
            row[n] = float(deep ? rows[2 * n] | rows[2 * n + 1] << 8 : rows[n]) / float((1 << bits) - 1);
        to.put_row(y, row.data(), channels);
    }
}

inline bool has_ending(std::string_view extension) {
    constexpr std::array<std::string_view, 4> endings{"heic", "heif", "hif", "avif"};
    return std::ranges::find(endings, extension) != endings.end();
}

// Returns false if the file is none of them. If its depth is wanted and there is none, its width stays 0.
inline bool read(const char *path, PictureFile &to) {
    std::array<char, 8> begin{};
    if (std::fread(begin.data(), 1, begin.size(), opened(path).get()) < 8 ||
        std::string_view(&begin[4], 4) != "ftyp")
        return false;
    const Owned context(call<void *>("heif_context_alloc"), {"heif_context_free"});
    check(call<Failure>("heif_context_read_from_file", context.get(), path, static_cast<void *>(nullptr)));
    void *primary = nullptr;
    check(call<Failure>("heif_context_get_primary_image_handle", context.get(), &primary));
    Owned handle(primary, release_handle);
    if (to.before.own_depth)
        handle = depth_of(primary);
    else
        describe(primary, to);
    if (!handle) return true;
    const auto said = [&](const char *name) { return call<int>(name, handle.get()); };
    to.said.orientation = 1;
    to.set_stored_size(said("heif_image_handle_get_width"), said("heif_image_handle_get_height"));
    to.said.pixel_aspect = 1;
    to.said.bits = said("heif_image_handle_get_luma_bits_per_pixel") > 8 ? 16 : 8;
    to.said.alpha = said("heif_image_handle_has_alpha_channel") != 0;
    if (to.said.alpha && said("heif_image_handle_is_premultiplied_alpha") != 0)
        throw std::runtime_error("its colours are multiplied by alpha: convert it to PNG");
    if (to.wants_pixels()) read_pixels(handle.get(), to);
    return true;
}

} // namespace sparselens::heif
