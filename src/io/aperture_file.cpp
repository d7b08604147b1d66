#include "io/aperture_file.h"

#include "base/error.h"
#include "io/exr/exr_flat.h"
#include "lens/picture_table.h"

#include <array>
#include <cmath>

namespace sparselens {

namespace {

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

} // namespace

std::shared_ptr<const AperturePicture> read_aperture_picture(const std::string &path) {
    const Image image = read_flat_exr(path).image;
    const std::array<std::size_t, 3> channels = weight_channels(image, path);
    auto picture = std::make_shared<AperturePicture>();
    picture->width = image.windows.width();
    picture->height = image.windows.height();
    for (std::size_t i = 0; i < image.windows.pixels(); ++i)
        for (const std::size_t channel : channels) {
            const float value = image.plane(channel)[i];
            if (!(value >= 0 && std::isfinite(value)))
                throw Error(path + ": a weight of the aperture is " + std::to_string(value) +
                            ": give values of at least 0");
            picture->rgb.push_back(value);
        }
    try {
        const PictureTable check(*picture, [](const Imath::V2d &) { return 1.0; });
    } catch (const Error &error) {
        throw Error(path + ": " + error.what());
    }
    return picture;
}

} // namespace sparselens
