#include "io/aperture_file.h"

#include "base/error.h"
#include "base/grid.h"
#include "io/exr/exr_flat.h"
#include "lens/picture_table.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sparselens {

namespace {

// The longest side. Tables of such a picture take 0.5 GB at most. The discs in a picture are smaller, or so far out of
// focus that more pixels would not show.
constexpr int most_pixels = 2048;

// The channels that weigh R, G and B.
std::array<std::size_t, 3> weight_channels(const Image &image, const std::string &path) {
    std::array<std::size_t, 3> rgb{find_channel(image.channels, "R"), find_channel(image.channels, "G"),
                                   find_channel(image.channels, "B")};
    if (rgb[0] != npos && rgb[1] != npos && rgb[2] != npos) return rgb;
    std::size_t only = find_channel(image.channels, "Y"), others = 0;
    for (std::size_t k = 0; k < image.channels.size() && only == npos; ++k)
        if (image.channels[k].name != "A") rgb.fill(k), ++others;
    if (only != npos) rgb.fill(only), others = 1;
    if (others != 1)
        throw Error(path + ": a picture of an aperture has the channels R, G and B, or Y, or a single one: "
                           "give such an EXR");
    return rgb;
}

// The picture reduced to `most_pixels`: each pixel is the mean of a square of as few pixels as possible. Pixels added
// beyond the border are black, half of them on each side.
AperturePicture means_of_squares(const Image &image, const std::array<std::size_t, 3> &channels,
                                 const std::string &path) {
    const int width = image.windows.width(), height = image.windows.height();
    const int side = pieces_of(std::max(width, height), most_pixels);
    AperturePicture picture{pieces_of(width, side), pieces_of(height, side), {}};
    picture.rgb.resize(std::size_t(picture.width) * std::size_t(picture.height) * 3);
    const int before_x = (picture.width * side - width) / 2, before_y = (picture.height * side - height) / 2;
    for (std::size_t k = 0; k < channels.size(); ++k) {
        const auto plane = image.plane(channels[k]);
        std::size_t i = 0;
        for (int y = 0; y < height; ++y) {
            const auto row = std::size_t((y + before_y) / side) * std::size_t(picture.width);
            for (int x = 0; x < width; ++x, ++i) {
                if (!(plane[i] >= 0 && std::isfinite(plane[i])))
                    throw Error(path + ": a weight of the aperture is " + std::to_string(plane[i]) +
                                ": give values of at least 0");
                picture.rgb[3 * (row + std::size_t((x + before_x) / side)) + k] +=
                    plane[i] / float(side) / float(side);
            }
        }
    }
    return picture;
}

} // namespace

std::shared_ptr<const AperturePicture> read_aperture_picture(const std::string &path) {
    const Image image = read_flat_exr(path).image;
    const auto picture =
        std::make_shared<const AperturePicture>(means_of_squares(image, weight_channels(image, path), path));
    try {
        const PictureTable check(*picture, [](const Imath::V2d &, std::size_t) { return 1.0; });
    } catch (const Error &error) {
        throw Error(path + ": " + error.what());
    }
    return picture;
}

} // namespace sparselens
