#include "base/error.h"
#include "deep/sanitize.h"
#include "io/camera/camera_header.h"
#include "io/exr/exr_common.h"
#include "python/arrays.h"
#include "python/job.h"
#include "python/verbs.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <limits>

namespace sparselens::python {

namespace {

// Returns the box of a keyword. Throws UsageError if it exceeds the coordinates that OpenEXR takes; so the lengths of
// its sides fit into an int.
std::optional<Imath::Box2i> window_from(Keywords &keywords, const char *name) {
    const auto box = keywords.box(name);
    constexpr int most = std::numeric_limits<int>::max() / 2;
    if (box && (std::min(box->min.x, box->min.y) <= -most || std::max(box->max.x, box->max.y) >= most))
        throw UsageError(fmt::format("{}: is outside the range of EXR windows, +-{} pixels", name, most));
    return box;
}

// Puts the windows that the keywords give in place of [0, width) x [0, height).
void set_windows(Windows &windows, Keywords &keywords) {
    if (const auto data = window_from(keywords, "data_window")) {
        const Grid grid(*data);
        if (grid.width() != windows.width() || grid.height() != windows.height())
            throw UsageError(fmt::format("data_window: is {} x {} pixels, but the arrays have {} x {}",
                                         grid.width(), grid.height(), windows.width(), windows.height()));
        windows.display = windows.data = *data;
    }
    windows.display = window_from(keywords, "display_window").value_or(windows.display);
    const double aspect = keywords.number("pixel_aspect").value_or(1);
    if (!(aspect >= 1e-6 && aspect <= 1e6))
        throw UsageError(fmt::format("pixel_aspect: must be from 1e-6 to 1e6, not {:g}", aspect));
    windows.pixel_aspect = float(aspect);
}

using Matrix = std::array<std::array<double, 4>, 4>;

// Returns the header that a file with these windows and this camera has.
Imf::Header header_for(const Windows &windows, Keywords &keywords) {
    Imf::Header header(windows.display, windows.data, windows.pixel_aspect);
    Camera camera;
    if (const py::object given = keywords.take("world_to_camera"); !given.is_none()) {
        Matrix m;
        try {
            m = given.cast<Matrix>();
        } catch (const py::cast_error &) {
            wrong_type("world_to_camera", "a matrix of 4 x 4 numbers", given);
        }
        camera.world_to_camera.emplace();
        for (int i = 0; i < 4; ++i)
            for (int k = 0; k < 4; ++k) (*camera.world_to_camera)[i][k] = m[std::size_t(i)][std::size_t(k)];
    }
    write_camera(header, camera);
    return header;
}

std::vector<std::string> channel_names(Keywords &keywords) {
    const py::object given = keywords.take("channels");
    if (given.is_none()) return {};
    try {
        if (!PyUnicode_Check(given.ptr())) return given.cast<std::vector<std::string>>();
    } catch (const py::cast_error &) {
    }
    wrong_type("channels", "a sequence of names", given);
}

Layout layout_of(Keywords &keywords) {
    return keywords.word<Layout>("layout", {{"hwc", Layout::hwc}, {"chw", Layout::chw}})
        .value_or(Layout::hwc);
}

std::vector<std::uint64_t> begin_from(const py::object &array, const Windows &windows, std::size_t samples) {
    auto begin = offsets_from(array, "begin", windows.pixels() + 1);
    if (begin.front() != 0 || begin.back() != samples)
        throw UsageError(
            fmt::format("begin: goes from {} to {}, but must go from 0 to the number of samples, {}",
                        begin.front(), begin.back(), samples));
    for (std::size_t i = 1; i < begin.size(); ++i)
        if (begin[i] < begin[i - 1])
            throw UsageError(fmt::format("begin: entry {} is {}, less than the one before", i, begin[i]));
    return begin;
}

Windows windows_from(Keywords &keywords) {
    const auto size = keywords.pixel("size");
    const bool sound = size && size->x > 0 && size->y > 0 && size->x <= 1 << 20 && size->y <= 1 << 20;
    if (!sound) throw UsageError("size: must be (width, height) in pixels, above 0");
    Windows windows = windows_of_size(size->x, size->y);
    set_windows(windows, keywords);
    return windows;
}

Ldi samples_from(const py::object &begin, const py::object &z, const py::object &channels,
                 const Windows &windows, Keywords &keywords) {
    Ldi ldi;
    ldi.windows = windows;
    ldi.z = floats_from(z, "z", 0);
    const std::size_t samples = ldi.samples();
    ldi.begin = begin_from(begin, windows, samples);
    if (samples == 0) throw UsageError("z: there are no samples");
    const auto optional = [&](const char *name) {
        const py::object array = keywords.take(name);
        return array.is_none() ? std::vector<float>() : floats_from(array, name, samples);
    };
    ldi.z_back = optional("z_back");
    for (std::size_t i = 0; i < ldi.z_back.size(); ++i)
        if (ldi.z_back[i] < ldi.z[i])
            throw UsageError(fmt::format("z_back: sample {} ends at {:g}, in front of its z, {:g}", i,
                                         ldi.z_back[i], ldi.z[i]));
    ldi.dx = optional("dx");
    ldi.dy = optional("dy");
    if (ldi.dx.empty() != ldi.dy.empty()) throw UsageError("dx: must be given with dy, or neither");
    ldi.weight = optional("weight");
    ldi.image_z = optional("optical");
    ldi.solid = optional("solid");
    if (!py::isinstance<py::dict>(channels)) wrong_type("channels", "a dict of names and arrays", channels);
    for (const auto &[key, array] : py::reinterpret_borrow<py::dict>(channels)) {
        const std::string name = py::str(key);
        Channel channel{name, PixelType::float32};
        ldi.values.push_back(values_from(py::reinterpret_borrow<py::object>(array),
                                         ("channels: " + name).c_str(), samples, channel.type));
        ldi.channels.push_back(std::move(channel));
    }
    return ldi;
}

} // namespace

ViewObject view_from(const py::object &image, const py::object &depth, const py::kwargs &given) {
    Keywords keywords("View", given);
    std::string name = keywords.text("name");
    if (name.empty()) name = "view";
    const Layout layout = layout_of(keywords);
    FlatFile file{.image = image_from(image, "image", layout, channel_names(keywords), "A"), .header = {}};
    const auto position = keywords.pair("position");
    OpenOptions options{lens_values(keywords), depth_options(keywords)};
    if (!depth.is_none()) {
        if (!options.depth.picture.depth.empty())
            throw UsageError("depth_channel: is given with an array of depth");
        if (find_channel(file.image.channels, "Z") != npos)
            throw UsageError("channels: Z is there, and an array of depth too; give one of the two");
        add_plane(file.image, depth, "z", "Z");
        options.depth.picture.depth = "Z";
    }
    set_windows(file.image.windows, keywords);
    file.header = header_for(file.image.windows, keywords);
    name_colours(file.image.channels, file.header);
    if (options.depth.picture.unpremultiplied) premultiply(file.image);
    keywords.done();
    ViewObject view{
        job<OpenedView>(py::none(), [&](Progress &) { return prepare_view(std::move(file), name, options); }),
        position};
    warn_of(name, view.in);
    return view;
}

LdiObject ldi_from(const py::object &begin, const py::object &z, const py::object &channels,
                   const py::kwargs &given) {
    Keywords keywords("Ldi", given);
    std::string name = keywords.text("name");
    if (name.empty()) name = "ldi";
    const Windows windows = windows_from(keywords);
    const OpenOptions options{lens_values(keywords), depth_options(keywords)};
    LdiFile file;
    file.ldi = samples_from(begin, z, channels, windows, keywords);
    file.header = header_for(windows, keywords);
    keywords.done();
    name_colours(file.ldi.channels, file.header);
    if (options.depth.picture.unpremultiplied) premultiply(file.ldi);
    auto ldi =
        job<OpenedLdi>(py::none(), [&](Progress &) { return prepare_ldi(std::move(file), name, options); });
    warn_of(name, ldi);
    return ldi;
}

PictureObject picture_from(const py::object &image, const py::kwargs &given) {
    Keywords keywords("Picture", given);
    const Layout layout = layout_of(keywords);
    PictureObject picture{image_from(image, "image", layout, channel_names(keywords), "Y"), {}};
    set_windows(picture.image.windows, keywords);
    keywords.done();
    name_colours(picture.image.channels, picture.header);
    return picture;
}

} // namespace sparselens::python
