// Pictures for programs that cannot open OpenEXR: PNG, JPEG, TIFF and the other formats that OpenImageIO writes.
#pragma once

#include "../../base/image.h"

#include <cstdint>
#include <string>
#include <vector>

namespace sparselens {

// Whether the extension is that of a format that OpenImageIO can write, other than OpenEXR.
bool is_shown_picture(const std::string &path);

// Whether the format holds linear light, as Radiance's .hdr does, and not colours for a display.
bool holds_linear_light(const std::string &path);

// Drops A if the format has none, before colours are encoded: the picture is then that over black. Returns whether A
// was below 1 anywhere.
bool drop_unwritten_coverage(const std::string &path, Image &image);

// The parts of a file beside its colours.
struct ShownExtras {
    int bits = 8;                        // of each value: 8 or 16; 32: floating-point numbers
    std::string profile = {}, exif = {}; // ICC, for R, G and B; Exif, without its orientation
};

// The bytes of a file of that format (an extension, without the dot): R, G and B (display values, premultiplied) of the
// display window, black outside the data window, with 8 bits, or 16 in TIFF, in DPX, and where `extras` says so and the
// format has them. 0 and less become 0, 1 and more the largest value, NaN becomes 0. If A is below 1 anywhere and the
// format has alpha, A is written too and the colours are unpremultiplied. Any number of threads may call it at the same
// time. Throws Error, beginning with `name`, if R, G or B is missing or OpenImageIO fails.
std::string shown_picture(const std::string &name, const std::string &format, const Image &image,
                          const ShownExtras &extras = {});

// The pixels of such a file of 8 bits that may have alpha (PNG), before encoding: 3 or 4 values each, by rows.
struct ShownPixels {
    int width = 0, height = 0, channels = 3;
    std::vector<std::uint8_t> values;
};
ShownPixels shown_pixels(const std::string &name, const Image &image);

// Writes the same as a file; its extension selects the format. The output is atomic (see OutputFile).
void write_shown_picture(const std::string &path, const Image &image, const ShownExtras &extras = {});

// Whether the extension is that of a picture that can be read, other than EXR. OpenImageIO is loaded only for unusual
// ones.
bool has_shown_ending(const std::string &path);

struct ShownFile {
    Image image; // upright
    ShownExtras extras;
    int orientation; // by which its rows were turned upright, 1 to 8 (Exif)
};

// The parts of a file that are read together:
// - picture: R, G and B, as encoded there, and A if it is below 1 anywhere; the colours are multiplied by A
// - without_alpha: R, G and B, not multiplied
// - own_depth: the depth that HEIC and AVIF have beside their colours, without A; an empty image if there is none
enum class ShownPart { picture, without_alpha, own_depth };

// Reads such a file. Throws Error, beginning with `path`.
ShownFile read_shown_picture(const std::string &path, ShownPart part = ShownPart::picture);

// Turns a picture of one channel by that orientation, as its file would have been.
Image turned(const Image &plane, int orientation);

// The names under which pictures may be written. The ending selects the format. A wrong ending is an error, reported
// before any work is done.
enum class OutputKind {
    exr,    // deep pictures, depths, and all else that only EXR can hold
    picture // EXR, or one of the formats for the screen
};

// What a picture may be, in words for help: all usual endings, because loading OpenImageIO takes long.
std::string picture_formats();

// Says why the name is wrong, with the list of endings; empty if it is right. `-`, pipes and devices need no ending.
std::string wrong_with_output(const std::string &path, OutputKind kind);

} // namespace sparselens
