// numpy arrays over the library's memory, and the library's pictures from numpy arrays.
//
// Pictures leave without a copy: an array looks into the memory of the object that it comes from and keeps it alive.
// Arrays that come in are copied once, from any strides, into the planes of the library. No other file of this folder
// uses numpy. Throws TypeError (not an array, or of another type) or UsageError (of another shape), which name the
// argument.
#pragma once

#include "base/image.h"
#include "python/keywords.h"

#include <pybind11/numpy.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace sparselens::python {

enum class Access { read_only, writable };

// The values as an array with these lengths of its dimensions; without lengths, one dimension. Ids (uint32) are their
// bits.
py::array shared(std::span<const float> values, const py::object &owner,
                 std::vector<std::size_t> lengths = {}, Access access = Access::read_only,
                 PixelType type = PixelType::float32);
py::array shared(std::span<const std::uint64_t> values, const py::object &owner);
py::array shared(std::span<const std::uint8_t> mask, const py::object &owner, std::size_t width); // of bool

// The picture as [channel][row][column].
py::array planes_of(const Image &image, const py::object &owner, Access access);
// The number of a channel, by its name or by another spelling of it (base/channel_kind.h). Throws KeyError if there is
// none.
std::size_t channel_named(std::span<const Channel> channels, const std::string &name);
// One channel as [row][column]. Throws KeyError if there is none of that name.
py::array plane_of(const Image &image, const std::string &channel, const py::object &owner, Access access);

// Copies an array of one value per sample or offset: one dimension, `count` entries (0: any number).
std::vector<float> floats_from(const py::object &array, const char *name, std::size_t count);
std::vector<std::uint64_t> offsets_from(const py::object &array, const char *name, std::size_t count);
// The same for floats or ids.
std::vector<float> values_from(const py::object &array, const char *name, std::size_t count, PixelType &type);

// How the dimensions of an array are ordered.
enum class Layout { hwc, chw };

// Makes a picture from an array of [row][column][channel] (hwc), [channel][row][column] (chw) or, for one channel,
// [row][column]. Without names, the channels are R, G, B (and A), or the single channel `alone`. Channels are stored as
// float.
Image image_from(const py::object &array, const char *name, Layout layout, std::vector<std::string> channels,
                 const std::string &alone);

// Adds a plane of [row][column] or [row][column][1], of the image's size.
void add_plane(Image &image, const py::object &array, const char *name, const std::string &channel);

} // namespace sparselens::python
