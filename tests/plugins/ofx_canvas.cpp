#include "ofx_canvas.h"

#include "pictures/picture.h"

#include <half.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <sstream>

namespace ofx_host {

namespace {

int components_of(const std::string &name) {
    return name == kOfxImageComponentRGBA ? 4 : name == kOfxImageComponentRGB ? 3 : 1;
}
std::size_t bytes_of(const std::string &depth) {
    return depth == kOfxBitDepthByte ? 1 : depth == kOfxBitDepthFloat ? 4 : 2;
}

double get(const unsigned char *from, const std::string &depth) {
    std::uint16_t two = 0;
    float four = 0;
    if (depth == kOfxBitDepthByte) return *from / 255.0;
    std::memcpy(&two, from, 2);
    if (depth == kOfxBitDepthShort) return two / 65535.0;
    if (depth == kOfxBitDepthHalf) {
        half value;
        value.setBits(two);
        return double(float(value));
    }
    std::memcpy(&four, from, 4);
    return double(four);
}

void put(double value, unsigned char *to, const std::string &depth) {
    if (depth == kOfxBitDepthByte) {
        *to = static_cast<unsigned char>(std::lround(value * 255));
    } else if (depth == kOfxBitDepthFloat) {
        const auto four = float(value);
        std::memcpy(to, &four, 4);
    } else {
        const auto two = depth == kOfxBitDepthShort ? std::uint16_t(std::lround(value * 65535))
                                                    : half(float(value)).bits();
        std::memcpy(to, &two, 2);
    }
}

std::vector<std::string> channels_of(const Canvas &canvas, bool is_depth) {
    if (is_depth) return {"Z"};
    if (canvas.components == kOfxImageComponentRGB) return {"R", "G", "B"};
    return {"R", "G", "B", "A"};
}

// Calls visit(x, y, index): rows from the top.
template <typename Visit>
void for_each_pixel(const Canvas &canvas, const Visit &visit) {
    std::size_t i = 0;
    for (int y = canvas.y1 + canvas.height - 1; y >= canvas.y1; --y)
        for (int x = canvas.x1; x < canvas.x1 + canvas.width; ++x) visit(x, y, i++);
}

} // namespace

std::string Words::text(const std::string &name, const std::string &otherwise) const {
    const auto found = find(name);
    return found == end() ? otherwise : found->second;
}
double Words::number(const std::string &name, double otherwise) const {
    return std::stod(text(name, std::to_string(otherwise)));
}

Canvas canvas_of(const Words &words) {
    Canvas canvas;
    const std::string depth = words.text("@depth", "float");
    canvas.depth = depth == "byte"    ? kOfxBitDepthByte
                   : depth == "short" ? kOfxBitDepthShort
                   : depth == "half"  ? kOfxBitDepthHalf
                                      : kOfxBitDepthFloat;
    const bool rgb = words.text("@components", "RGBA") == "RGB";
    canvas.components = rgb ? kOfxImageComponentRGB : kOfxImageComponentRGBA;
    canvas.scale = words.number("@scale", 1);
    canvas.aspect = words.number("@aspect", 1);
    std::istringstream size(words.text("@size", "64x36"));
    char by = 0;
    double width = 0, height = 0;
    size >> width >> by >> height;
    canvas.display_width = canvas.width = int(std::ceil(width * canvas.scale));
    canvas.display_height = canvas.height = int(std::ceil(height * canvas.scale));
    canvas.downwards = words.text("@rows", "up") == "down";
    canvas.unpremultiplied = words.yes("@unpremultiplied");
    return canvas;
}

std::shared_ptr<Image> image_of(const Canvas &canvas) {
    const auto image = std::make_shared<Image>();
    const std::size_t pixel = bytes_of(canvas.depth) * std::size_t(components_of(canvas.components));
    const std::size_t row = std::size_t(canvas.width) * pixel;
    *image = {{}, canvas.x1, canvas.y1, canvas.width, canvas.height, pixel, {}, canvas.downwards};
    image->memory.assign(row * std::size_t(canvas.height), 0x3f);
    Properties &properties = image->properties;
    const int bounds[] = {canvas.x1, canvas.y1, canvas.x1 + canvas.width, canvas.y1 + canvas.height};
    for (int i = 0; i < 4; ++i) properties.set<int>(kOfxImagePropBounds, bounds[i], i);
    properties.set<int>(kOfxImagePropRowBytes, canvas.downwards ? -int(row) : int(row));
    properties.set<void *>(kOfxImagePropData, image->pixel(canvas.x1, canvas.y1));
    properties.set<std::string>(kOfxImageEffectPropPixelDepth, canvas.depth);
    properties.set<std::string>(kOfxImageEffectPropComponents, canvas.components);
    properties.set<double>(kOfxImagePropPixelAspectRatio, canvas.aspect);
    properties.set<std::string>(kOfxImageEffectPropPreMultiplication,
                                canvas.unpremultiplied ? kOfxImageUnPreMultiplied : kOfxImagePreMultiplied);
    return image;
}

std::shared_ptr<Image> read_image(const std::string &file, Canvas canvas, bool is_depth) {
    const pictures::Picture picture = pictures::read(file);
    if (picture.width() != canvas.width || picture.height() != canvas.height)
        throw std::runtime_error(file + " has another size");
    if (is_depth) {
        canvas.depth = kOfxBitDepthFloat;
        canvas.components = kOfxImageComponentAlpha;
    }
    const auto image = image_of(canvas);
    const std::vector<std::string> names = channels_of(canvas, is_depth);
    for (std::size_t k = 0; k < names.size(); ++k) {
        const std::vector<double> &values = picture.channel(names[k]).values;
        for_each_pixel(canvas, [&](int x, int y, std::size_t i) {
            put(values[i], image->pixel(x, y) + k * bytes_of(canvas.depth), canvas.depth);
        });
    }
    return image;
}

void write_image(Image &image, const Canvas &canvas, const std::string &file) {
    const int top = canvas.display_height - canvas.y1 - canvas.height;
    pictures::Picture picture{
        Imf::Header({{0, 0}, {canvas.display_width - 1, canvas.display_height - 1}},
                    {{canvas.x1, top}, {canvas.x1 + canvas.width - 1, top + canvas.height - 1}})};
    picture.samples.assign(std::size_t(canvas.width) * std::size_t(canvas.height), 1);
    for (const std::string &name : channels_of(canvas, false)) {
        const std::size_t at = picture.channels.size() * bytes_of(canvas.depth);
        picture.channels.push_back({name, Imf::FLOAT});
        for_each_pixel(canvas, [&](int x, int y, std::size_t) {
            picture.channels.back().values.push_back(get(image.pixel(x, y) + at, canvas.depth));
        });
    }
    pictures::write(picture, file);
}

} // namespace ofx_host
