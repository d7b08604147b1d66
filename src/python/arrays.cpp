#include "python/arrays.h"

#include "base/channel_kind.h"
#include "base/error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cstring>

namespace sparselens::python {

namespace {

std::string shape_text(const py::array &array) {
    return fmt::format("({}{})", fmt::join(array.shape(), array.shape() + array.ndim(), ", "),
                       array.ndim() == 1 ? "," : "");
}

// Returns an object as an array with elements of type Element; else throws TypeError.
template <typename Element>
py::array array_of(const py::object &object, const char *name, const char *type) {
    const std::string wanted = fmt::format("a numpy array of {}", type);
    if (!py::isinstance<py::array>(object)) wrong_type(name, wanted.c_str(), object);
    auto array = py::reinterpret_borrow<py::array>(object);
    if (!py::isinstance<py::array_t<Element>>(object))
        throw py::type_error(fmt::format("{0}: must be {1}, not {2}; convert it by .astype(numpy.{3})", name,
                                         wanted, std::string(py::str(array.dtype())), type));
    return array;
}

py::array one_dimension(py::array array, const char *name, std::size_t count) {
    if (array.ndim() != 1)
        Keywords::refuse(name, "an array of one dimension", "of shape " + shape_text(array));
    if (count > 0 && std::size_t(array.shape(0)) != count)
        Keywords::refuse(name, fmt::format("an array of {} values", count),
                         fmt::format("{}", array.shape(0)));
    return array;
}

template <typename Element>
std::vector<Element> copied(const py::array &array) {
    std::vector<Element> values(std::size_t(array.shape(0)));
    const auto *from = static_cast<const char *>(array.data());
    for (Element &value : values) {
        std::memcpy(&value, from, sizeof(Element));
        from += array.strides(0);
    }
    return values;
}

// The strides in bytes of a picture's dimensions.
struct PictureStrides {
    std::size_t height, width, channels;
    py::ssize_t row, pixel, channel;
};

PictureStrides strides_of(const py::array &array, const char *name, Layout layout) {
    if (array.ndim() != 2 && array.ndim() != 3)
        Keywords::refuse(name, "an array of (rows, columns, channels) or (rows, columns)",
                         "of shape " + shape_text(array));
    const int first = array.ndim() == 3 && layout == Layout::chw ? 1 : 0; // dimension of the rows
    const bool one = array.ndim() == 2;
    const int channel = layout == Layout::chw ? 0 : 2;
    PictureStrides s{std::size_t(array.shape(first)),
                     std::size_t(array.shape(first + 1)),
                     one ? 1 : std::size_t(array.shape(channel)),
                     array.strides(first),
                     array.strides(first + 1),
                     one ? 0 : array.strides(channel)};
    if (s.height == 0 || s.width == 0 || s.channels == 0 || s.height > 1u << 20 || s.width > 1u << 20)
        Keywords::refuse(name, "an array with pixels", "of shape " + shape_text(array));
    return s;
}

void copy_plane(const py::array &array, const PictureStrides &s, std::size_t channel,
                std::span<float> plane) {
    const auto *from = static_cast<const char *>(array.data()) + py::ssize_t(channel) * s.channel;
    for (std::size_t y = 0; y < s.height; ++y, from += s.row) {
        float *to = &plane[y * s.width];
        if (s.pixel == sizeof(float))
            std::memcpy(to, from, s.width * sizeof(float));
        else
            for (std::size_t x = 0; x < s.width; ++x)
                std::memcpy(to + x, from + py::ssize_t(x) * s.pixel, sizeof(float));
    }
}

std::vector<std::string> usual_names(std::size_t count, const char *name, const std::string &alone) {
    if (count == 1) return {alone};
    if (count == 3) return {"R", "G", "B"};
    if (count == 4) return {"R", "G", "B", "A"};
    throw UsageError(fmt::format("channels: {} has {} of them, so they must be named", name, count));
}

} // namespace

py::array shared(std::span<const float> values, const py::object &owner, std::vector<std::size_t> lengths,
                 Access access, PixelType type) {
    if (lengths.empty()) lengths = {values.size()};
    const py::dtype element =
        type == PixelType::uint32 ? py::dtype::of<std::uint32_t>() : py::dtype::of<float>();
    py::array array(element, lengths, values.data(), owner);
    if (access == Access::read_only) array.attr("setflags")(py::arg("write") = false);
    return array;
}

py::array shared(std::span<const std::uint64_t> values, const py::object &owner) {
    py::array array(py::dtype::of<std::uint64_t>(), {values.size()}, values.data(), owner);
    array.attr("setflags")(py::arg("write") = false);
    return array;
}

py::array shared(std::span<const std::uint8_t> mask, const py::object &owner, std::size_t width) {
    py::array array(py::dtype::of<bool>(), {mask.size() / width, width}, mask.data(), owner);
    array.attr("setflags")(py::arg("write") = false);
    return array;
}

py::array planes_of(const Image &image, const py::object &owner, Access access) {
    return shared(
        image.values, owner,
        {image.channels.size(), std::size_t(image.windows.height()), std::size_t(image.windows.width())},
        access);
}

std::size_t channel_named(std::span<const Channel> channels, const std::string &name) {
    std::size_t k = find_channel(channels, name);
    if (k == npos) k = find_channel(channels, colour_name(name));
    if (k == npos) throw py::key_error(name);
    return k;
}

py::array plane_of(const Image &image, const std::string &channel, const py::object &owner, Access access) {
    const std::size_t k = channel_named(image.channels, channel);
    return shared(image.plane(k), owner,
                  {std::size_t(image.windows.height()), std::size_t(image.windows.width())}, access,
                  image.channels[k].type);
}

std::vector<float> floats_from(const py::object &array, const char *name, std::size_t count) {
    return copied<float>(one_dimension(array_of<float>(array, name, "float32"), name, count));
}

std::vector<std::uint64_t> offsets_from(const py::object &array, const char *name, std::size_t count) {
    return copied<std::uint64_t>(one_dimension(array_of<std::uint64_t>(array, name, "uint64"), name, count));
}

std::vector<float> values_from(const py::object &array, const char *name, std::size_t count,
                               PixelType &type) {
    type = PixelType::float32;
    if (!py::isinstance<py::array_t<std::uint32_t>>(array)) return floats_from(array, name, count);
    type = PixelType::uint32;
    const auto ids =
        copied<std::uint32_t>(one_dimension(py::reinterpret_borrow<py::array>(array), name, count));
    std::vector<float> values(ids.size());
    std::ranges::transform(ids, values.begin(), [](std::uint32_t id) { return std::bit_cast<float>(id); });
    return values;
}

Image image_from(const py::object &object, const char *name, Layout layout, std::vector<std::string> channels,
                 const std::string &alone) {
    const py::array array = array_of<float>(object, name, "float32");
    const PictureStrides s = strides_of(array, name, layout);
    if (channels.empty()) channels = usual_names(s.channels, name, alone);
    if (channels.size() != s.channels)
        throw UsageError(fmt::format("channels: there are {} names, but {} has {} channels (shape {})",
                                     channels.size(), name, s.channels, shape_text(array)));
    std::vector<Channel> stored;
    for (std::string &channel : channels) {
        if (find_channel(stored, channel) != npos)
            throw UsageError(fmt::format("channels: '{}' is there twice", channel));
        stored.push_back({std::move(channel), PixelType::float32});
    }
    Image image(windows_of_size(int(s.width), int(s.height)), std::move(stored));
    for (std::size_t k = 0; k < s.channels; ++k) copy_plane(array, s, k, image.plane(k));
    return image;
}

void add_plane(Image &image, const py::object &object, const char *name, const std::string &channel) {
    const py::array array = array_of<float>(object, name, "float32");
    const PictureStrides s = strides_of(array, name, Layout::hwc);
    const Windows &w = image.windows;
    if (s.channels != 1 || s.height != std::size_t(w.height()) || s.width != std::size_t(w.width()))
        Keywords::refuse(name, fmt::format("of shape ({}, {}), as the image is", w.height(), w.width()),
                         shape_text(array));
    image.channels.push_back({channel, PixelType::float32});
    image.values.resize(image.channels.size() * w.pixels());
    copy_plane(array, s, 0, image.plane(image.channels.size() - 1));
}

} // namespace sparselens::python
