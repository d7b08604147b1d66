// OpenImageIO as a module that is loaded only to write or read a picture. Loading its two hundred libraries
// takes 0.2 s, longer than most pictures take to gather; without them a tool starts in 0.015 s.
//
// The interface is in C, so no exception and no object crosses it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace sparselens {

// Bytes that a file holds beside its pixels. A module's are valid until the thread calls again.
struct OiioBytes {
    const void *bytes;
    std::size_t size; // 0: none
};

struct OiioPicture {
    const char *format; // its extension (png, without the dot)
    const char *path; // of a file for the formats that are written only to files; it need not end in `format`
    void *source;
    const float *(*row)(void *source, int y); // row y from the top: pixel by pixel, channels together
    int width, height;
    int channels;       // 3, or 4 with unassociated alpha
    int bits;           // 8, or 16 if the format has them
    float pixel_aspect; // width over height
    OiioBytes profile;  // ICC, for R, G and B
    OiioBytes exif;     // as a TIFF structure
    // Takes the bytes of the other formats, piece by piece: where a file cannot grow, libpng's is cut off in silence, and
    // libjpeg ends the process.
    void (*put)(void *bytes, const void *piece, std::size_t count);
    void *bytes;
};

struct OiioFile {
    int width, height; // upright
    int orientation;   // by which its rows are turned upright, the attribute of Exif, 1 to 8
    float pixel_aspect;
    int bits;   // 8 or 16; 32: floating-point numbers
    bool alpha; // whether there is a fourth channel
    OiioBytes profile, exif;
    // Asked: read the depth that the file has beside its colours. The width is 0 if it has none.
    bool own_depth;
};

struct OiioModule {
    enum class Support { none, opaque, alpha };

    // Tells what can be written in the format with this extension (png, without the dot).
    Support (*support)(const char *extension);
    // Whether it is the extension of a picture that can be read, other than EXR.
    bool (*reads)(const char *extension);
    // Returns null, or a message that is valid until the thread calls again.
    const char *(*write)(const OiioPicture &picture);
    // Describes a file if `values` is null. Otherwise reads R, G and B, and A if it has alpha, plane after plane, turned
    // upright. The colours are not multiplied by A.
    const char *(*read)(const char *path, OiioFile &file, float *values);
};

inline constexpr const char *oiio_module_entry = "sparselens_oiio_module";

// The index of a stored pixel in the picture that is turned upright, by the attribute Orientation of Exif, 1 to 8. From 5
// on, rows become columns.
inline std::size_t upright(int x, int y, int stored_width, int stored_height, int orientation) {
    const auto is = [&](auto... one) { return ((orientation == one) || ...); };
    const auto column = std::size_t(is(2, 3, 7, 8) ? stored_width - 1 - x : x),
               row = std::size_t(is(3, 4, 6, 7) ? stored_height - 1 - y : y);
    return orientation > 4 ? column * std::size_t(stored_height) + row
                           : row * std::size_t(stored_width) + column;
}

// Rounds as OpenImageIO does; NaN becomes 0.
inline std::uint8_t in_8_bits(float value) {
    const float scaled = value * 255 + 0.5f;
    return scaled >= 0 ? std::uint8_t(std::min(scaled, 255.0f)) : std::uint8_t(0);
}

} // namespace sparselens
