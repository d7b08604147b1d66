#include "io/photograph.h"

#include "base/error.h"
#include "deep/flatten.h"
#include "io/display/icc_profile.h"
#include "io/display/shown_picture.h"
#include "io/exr/exr_channels.h"
#include "io/exr/exr_deep_part.h"
#include "io/exr/exr_flat.h"
#include "io/exr/exr_header.h"
#include "io/files/file_stream.h"
#include "io/files/text_file.h"
#include "io/own_depth.h"
#include "lens/photograph.h"
#include "view/fitted_depth.h"

#include <ImfChromaticitiesAttribute.h>
#include <ImfIntAttribute.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <utility>

namespace sparselens {

namespace {

constexpr const char *bits_name = "photograph:bits", *profile_name = "photograph:profile",
                     *exif_name = "photograph:exif";

// As a flat EXR would be read, with what it states about its colours.
struct Photograph : FlatFile {
    int orientation = 1; // as stored
};

Photograph flat_file(ShownFile shown) {
    Photograph file;
    file.image = std::move(shown.image);
    file.orientation = shown.orientation;
    const Windows &windows = file.image.windows;
    file.header = Imf::Header(windows.display, windows.data, windows.pixel_aspect);
    if (shown.extras.bits == 32) {
        set_attribute(file.header, "chromaticities", Imf::ChromaticitiesAttribute(Imf::Chromaticities()));
        return file;
    }
    set_attribute(file.header, "oiio:ColorSpace", Imf::StringAttribute("srgb_texture"));
    set_attribute(file.header, bits_name, Imf::IntAttribute(shown.extras.bits));
    const std::string &profile = shown.extras.profile;
    if (is_rgb_profile(profile))
        set_attribute(file.header, profile_name, Imf::StringAttribute(profile));
    else if (!profile.empty())
        file.warnings.emplace_back("its colour profile is not for R, G and B, and is left out");
    if (const std::string &exif = shown.extras.exif; !exif.empty())
        set_attribute(file.header, exif_name, Imf::StringAttribute(exif));
    return file;
}

// Whether two frames have the same shape, within a pixel of either.
bool alike(std::int64_t width, std::int64_t height, const Windows &other) {
    const std::int64_t w = other.display_width(), h = other.display_height();
    return std::abs(width * h - height * w) <= std::max({width, height, w, h});
}
bool alike(const Windows &a, const Windows &b) { return alike(a.display_width(), a.display_height(), b); }
bool alike_if_turned(const Windows &a, const Windows &b) {
    return !alike(a, b) && alike(a.display_height(), a.display_width(), b);
}

// Turns a depth of the shape of the picture's stored rows as these were turned.
void turn_depth(FlatFile &depth, const std::string &name, Photograph &picture) {
    if (picture.orientation < 5 || !alike_if_turned(depth.image.windows, picture.image.windows)) return;
    depth.image.channels.resize(1);
    depth.image = turned(depth.image, picture.orientation);
    picture.warnings.push_back("is turned by its Exif, and " + name + " is not: the depth is turned, too");
}

bool is_grey(const Image &image) {
    constexpr float rounding = 0.03f; // of JPEG
    const auto r = image.plane(0);
    for (std::size_t k = 1; k < image.channels.size(); ++k)
        for (std::size_t i = 0; i < r.size(); ++i)
            if (std::abs(image.plane(k)[i] - r[i]) > rounding) return false;
    return true;
}

void require_grey(const Image &image, const std::string &name) {
    if (!is_grey(image))
        throw Error(name + ": has colours, and depth must be grey: let the estimator write it without a "
                           "colour map, white near (`depth_file`)");
}

void require_shape(const Windows &depth, const std::string &name, const Windows &picture,
                   const std::string &path) {
    if (alike(depth, picture)) return;
    const int width = depth.display_width(), height = depth.display_height();
    const bool on_side = alike_if_turned(depth, picture);
    const double shape = double(picture.display_height()) / picture.display_width();
    throw Error(
        fmt::format("{}: is {}x{} pixels large, and {} is {}x{}: {} (oiiotool {} --{} -o NEW)", name, width,
                    height, path, picture.display_width(), picture.display_height(),
                    on_side ? "turn it" : "give the depth of the whole picture, and of its shape", name,
                    on_side ? "rotate90, or --rotate270,"
                            : fmt::format("resize {}x{}", width, std::max(1l, std::lround(width * shape)))));
}

// Gives the windows the corner and the shape of the pixels of another frame of that size: only EXR files have a corner.
void move_frame(Windows &windows, const Windows &to) {
    const Imath::V2i by = to.display.min - windows.display.min;
    for (Imath::V2i *corner : {&windows.data.min, &windows.data.max}) *corner += by;
    windows.display = to.display;
    windows.pixel_aspect = to.pixel_aspect;
}

// The depth (R) in the pixels of `data`: beyond its own, that of the nearest pixel.
Image extended(const Image &depth, const Imath::Box2i &data) {
    const Imath::Box2i &own = depth.windows.data;
    Image result({depth.windows.display, data, depth.windows.pixel_aspect}, {{"R", PixelType::float32}});
    for (int y = data.min.y; y <= data.max.y; ++y)
        for (int x = data.min.x; x <= data.max.x; ++x)
            result.at(0, x, y) =
                depth.at(0, std::clamp(x, own.min.x, own.max.x), std::clamp(y, own.min.y, own.max.y));
    return result;
}

// A channel of a depth with another number of pixels, in the pixels of the picture.
Image fitted(const Image &depth, std::size_t channel, const Image &picture) {
    const Windows &own = depth.windows;
    const Grid cells(own.display);
    std::vector<float> values(cells.size()); // beyond the data window: nothing
    const Imath::Box2i both = common_box(own.data, own.display);
    for (int y = both.min.y; y <= both.max.y; ++y)
        for (int x = both.min.x; x <= both.max.x; ++x)
            values[cells.index(Imath::V2i(x, y))] = depth.at(channel, x, y);
    Image result(picture.windows, {depth.channels[channel]});
    std::ranges::copy(fit_depth(picture, cells.array(), values), result.values.begin());
    return result;
}

// Gives the depth the frame of the picture, in which it has the same number of pixels.
void put_in_frame(FlatFile &depth, const PictureChoice &choice, Photograph &picture,
                  const std::string &path) {
    const std::string &name = choice.depth_file;
    const Windows &from = depth.image.windows, &to = picture.image.windows;
    require_shape(from, name, to, path);
    if (from.display.size() == to.display.size()) return move_frame(depth.image.windows, to);
    picture.notes.push_back(fmt::format("depth: {}x{} pixels, fitted to the colours of {}x{}",
                                        from.display_width(), from.display_height(), to.display_width(),
                                        to.display_height()));
    const std::string channel = depth_of(depth.image.channels, choice.depth, name).name;
    depth.image = fitted(depth.image, find_channel(depth.image.channels, channel), picture.image);
}

// The depth in the photograph itself, as a disparity, turned as the picture is.
FlatFile own_depth(const std::string &path, const Photograph &picture) try {
    const std::string bytes = read_bytes(path);
    const auto of_jpeg = bytes.starts_with("\xff\xd8") ? own_depth_of_jpeg(bytes) : std::nullopt;
    const MemoryFile file(of_jpeg ? of_jpeg->picture : "");
    ShownFile shown = of_jpeg ? read_shown_picture(file.path(), ShownPart::without_alpha)
                              : read_shown_picture(path, ShownPart::own_depth);
    if (shown.image.values.empty())
        throw UsageError(path +
                         ": is a picture without depth: give its depth by `depth_file` (grey, white near), "
                         "as programs such as Depth Anything estimate it");
    Photograph depth = flat_file(std::move(shown));
    if (!is_grey(depth.image)) throw Error("it has colours");
    depth.image.channels.resize(1);
    depth.image = turned(depth.image, depth.orientation == 1 ? picture.orientation : 1);
    if (of_jpeg) make_disparities(*of_jpeg, depth.image.plane(0));
    const Windows &from = depth.image.windows, &to = picture.image.windows;
    if (!alike(from, to))
        throw Error(fmt::format("it has {}x{} pixels, another shape than the picture with {}x{}",
                                from.display_width(), from.display_height(), to.display_width(),
                                to.display_height()));
    return depth;
} catch (const UsageError &) {
    throw;
} catch (const std::runtime_error &error) {
    const std::string why = error.what();
    const std::size_t name = why.starts_with("/proc/") || why.starts_with(path) ? why.find(": ") + 2 : 0;
    throw Error(fmt::format("{}: its own depth cannot be used: {}; give another one by `depth_file`", path,
                            why.substr(name)));
}

} // namespace

bool is_photograph(const std::string &path, const PictureChoice &choice) {
    return has_shown_ending(path) || has_shown_ending(choice.depth_file);
}

LdiFile read_photograph(const std::string &path, const PictureChoice &choice) {
    PictureChoice colours = choice;
    colours.depth_file.clear();
    Photograph picture = has_shown_ending(path) ? flat_file(read_shown_picture(path))
                                                : Photograph{read_flat_exr(path, colours)};
    const bool own = choice.depth_file.empty();
    const std::string &name = own ? path : choice.depth_file;
    const bool shown = has_shown_ending(name);
    FlatFile depth = own     ? own_depth(path, picture)
                     : shown ? flat_file(read_shown_picture(name, ShownPart::without_alpha))
                             : read_depth_file(choice);
    if (shown && !own) require_grey(depth.image, name), turn_depth(depth, name, picture);
    const PictureChoice of_depth = shown ? PictureChoice{.depth_file = name} : choice;
    put_in_frame(depth, of_depth, picture, display_name(path));
    if (shown) depth.image = extended(depth.image, picture.image.windows.data);
    put_depth_of_file(picture, path, of_depth, depth);
    return {ldi_of_flat(picture.image, "Z"), picture.header, false, std::move(picture.notes),
            std::move(picture.warnings)};
}

std::optional<ShownExtras> extras_of(const Imf::Header &header) {
    const auto *bits = header.findTypedAttribute<Imf::IntAttribute>(bits_name);
    if (!bits) return {};
    const auto bytes_of = [&](const char *name) {
        const auto *bytes = header.findTypedAttribute<Imf::StringAttribute>(name);
        return bytes ? bytes->value() : std::string();
    };
    return ShownExtras{bits->value(), bytes_of(profile_name), bytes_of(exif_name)};
}

Imf::Header without_extras(const Imf::Header &header) {
    Imf::Header result = header;
    for (const char *name : {bits_name, profile_name, exif_name})
        if (header.find(name) != header.end()) result = without_attribute(result, name);
    return result;
}

namespace {

// The mean of those that are numbers.
double mean_of(std::span<const float> depths) {
    double sum = 0, count = 0;
    for (const float d : depths)
        if (std::isfinite(d)) sum += double(d), ++count;
    return count > 0 ? sum / count : 0;
}

std::optional<DisparityRange> range_of(std::span<const float> depths) {
    DisparityRange range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (const float d : depths)
        if (std::isfinite(d)) range = {std::min(range.least, double(d)), std::max(range.most, double(d))};
    if (range.most > range.least) return range;
    return {};
}

} // namespace

void repair_disparities(std::span<float> depths, const std::string &name, std::vector<std::string> &warnings,
                        std::optional<DisparityRange> &range) {
    const std::optional<DisparityRange> own = range_of(depths);
    if (!own)
        throw Error(name +
                    ": its depth is the same everywhere, so that nothing can be out of focus: give another "
                    "`depth_file`");
    const double size = own->most - own->least;
    constexpr double little =
        0.25; // of the range from 0 to 1: the blur is far from the one that was asked for
    if (!range && (own->least < 0 || own->most > 1)) {
        range = own;
        warnings.push_back(
            fmt::format("its depth goes from {:g} to {:g}, and is scaled to 0 to 1", own->least, own->most));
    } else if (!range && size < little) {
        warnings.push_back(fmt::format(
            "its depth goes from {:.3g} to {:.3g} of 0 to 1 only, and the blur with it: stretch it "
            "(oiiotool DEPTH --subc {:.3g} --divc {:.3g} -o NEW); a distance in millimetres needs "
            "`depth=normalized`, `near=0`, `far=65.535` and a lens",
            own->least, own->most, own->least, size));
    }
    constexpr double clear = 0.25; // of the range: the ground is nearer than what is above it
    const std::size_t quarter = depths.size() / 4;
    if (mean_of(depths.last(quarter)) - mean_of(depths.first(quarter)) < -clear * size)
        warnings.emplace_back(
            "its depth is darker below than above, and white must be near: if white is far, "
            "invert it (oiiotool DEPTH --invert -o NEW); if it stands on its head, turn it");
    const DisparityRange by = range.value_or(DisparityRange{0, 1});
    constexpr double farthest = -0.9; // of a later frame: depth_of_disparity() needs more than -1
    for (float &d : depths)
        d = std::isfinite(d)
                ? float(std::max((double(d) - by.least) / (by.most - by.least), range ? farthest : 0))
                : std::numeric_limits<float>::quiet_NaN();
}

std::optional<PixelInFocus> usual_focus(const Ldi &ldi) {
    const Imath::Box2i &frame = ldi.windows.display;
    const Imath::V2i quarter = frame.size() / 4;
    const Imath::Box2i middle = common_box(ldi.windows.data, {frame.min + quarter, frame.max - quarter});
    const int step = 1 + frame.size().x / 512; // some pixels tell enough
    std::vector<PixelInFocus> found;
    for (int y = middle.min.y; y <= middle.max.y; y += step)
        for (int x = middle.min.x; x <= middle.max.x; x += step)
            if (const float z = front_depth(ldi, {x, y}); z > 0) found.push_back({{x, y}, double(z)});
    if (found.empty()) return {};
    std::ranges::stable_sort(found, {}, &PixelInFocus::depth);
    const Imath::V2i centre = frame.min + frame.size() / 2;
    const auto around_median = std::span(found).subspan(found.size() / 8, found.size() / 12 + 1);
    return *std::ranges::min_element(around_median, {},
                                     [&](const PixelInFocus &one) { return (one.pixel - centre).length2(); });
}

Camera photograph_camera() {
    Camera camera;
    camera.focal_length_mm = camera.sensor_width_mm = 36;
    return camera;
}

} // namespace sparselens
