// The depth that a phone puts into a JPEG beside its colours, in one of three ways:
//
// - GDepth (Google): a PNG or JPEG as base64 in the XMP, which may go on in extended XMP;
// - Dynamic Depth (Android): a picture behind that of the JPEG, as a directory of items in the XMP says;
// - Apple: a JPEG behind that of the JPEG, whose own XMP says that it is a disparity or a depth.
//
// Google's values v, from 0 to 1, mean (https://developers.google.com/depthmap-metadata/encoding)
//
//     z = near + v (far - near)                       RangeLinear
//     1 / z = 1 / near - v (1 / near - 1 / far)       RangeInverse
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace sparselens {

struct OwnDepth {
    enum class Values { disparity, inverse, linear }; // inverse and linear: black is near

    std::string picture; // the bytes of a PNG or JPEG, not turned
    Values values = Values::disparity;
    double near = 0, far = 0; // of linear ones
};

// Finds it in the bytes of a JPEG. Throws std::runtime_error, which says why, if the file has one that cannot be used.
std::optional<OwnDepth> own_depth_of_jpeg(std::string_view file);

// Makes a disparity of each value, 1 at the nearest depth and 0 at the farthest one that the format has.
void make_disparities(const OwnDepth &of, std::span<float> values);

} // namespace sparselens
