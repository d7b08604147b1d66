#include "io/lens_file.h"

#include "base/error.h"
#include "base/grid.h"
#include "base/text.h"
#include "io/exr/exr_flat.h"
#include "io/files/file_stream.h"
#include "io/files/text_file.h"
#include "lens/aperture.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

namespace sparselens {

namespace {

using Json = nlohmann::json;

std::string beside(const std::string &path, const std::string &name) {
    return (std::filesystem::path(path).parent_path() / name).string();
}

class Reader {
public:
    Reader(const std::string &path, std::optional<double> fstop) : path_(path), fstop_(fstop) {}

    LensFile read() {
        const Json json = read_json_file(path_);
        if (!json.is_object())
            throw Error(display_name(path_) +
                        ": not a JSON object: expected e.g. {\"name\": \"Petzval\", \"cat-eye\": 1}");
        LensFile file;
        for (const auto &[key, value] : json.items()) read_key(file, key, value);
        return file;
    }

private:
    [[noreturn]] void refuse(const std::string &key, const Json &value, const std::string &expected) const {
        throw Error(fmt::format("{}: '{}' is {}, not {}", path_, key, shown_in_message(value), expected));
    }

    static const LookNumber *number_called(const std::string &key) {
        for (const auto table : {look_numbers(), highlight_numbers()})
            for (const LookNumber &number : table)
                if (key == number.name) return &number;
        return nullptr;
    }

    void read_key(LensFile &file, const std::string &key, const Json &value) {
        if (const LookNumber *number = number_called(key)) {
            file.values.*(number->value) = number_at(key, value, number->range);
        } else if (key == "name") {
            if (!value.is_string()) refuse(key, value, "a text");
            file.name = value.get<std::string>();
        } else if (key == "aperture") {
            if (!value.is_string() || is_standard_stream(value.get<std::string>()))
                refuse(key, value, "the name of a file");
            file.values.picture = read_aperture_picture(beside(path_, value.get<std::string>()));
        } else if (key == "cat-eye-darkening") {
            if (!value.is_boolean()) refuse(key, value, "true or false");
            file.values.cat_eye_darkening = value.get<bool>();
        } else if (key == "axial-chromatic-type") {
            const auto types = chromatic_types();
            const auto type =
                std::ranges::find_if(types, [&](const auto &t) { return value == Json(t.first); });
            if (type == types.end()) refuse(key, value, "red-blue, blue-yellow or green-magenta");
            file.values.chromatic_type = type->second;
        } else if (key == "tilt") {
            if (!value.is_array() || value.size() != 2) refuse(key, value, "[X, Y] in degrees");
            file.values.tilt_x = number_at(key, value[0], {"degrees", is_tilt});
            file.values.tilt_y = number_at(key, value[1], {"degrees", is_tilt});
        } else {
            throw Error(
                fmt::format("{}: '{}' is no look of a lens: give options' names without dashes", path_, key));
        }
    }

    double number_at(const std::string &key, const Json &value, const NumberRange &range) const {
        if (value.is_object()) return by_fstop(key, value, range);
        return plain_number(key, value, range);
    }

    double plain_number(const std::string &key, const Json &value, const NumberRange &range) const {
        if (!value.is_number() || !range.holds(value.get<double>())) refuse(key, value, range.words);
        return value.get<double>();
    }

    double by_fstop(const std::string &key, const Json &value, const NumberRange &range) const {
        std::map<double, double> by_stops; // log2 of the f-number
        for (const auto &[text, v] : value.items()) {
            const auto fstop = number_of<double>(text);
            if (!fstop || !(*fstop > 0) || !std::isfinite(*fstop))
                refuse(key + "' for '" + text, v, "for an f-number, e.g. \"1.4\"");
            by_stops[std::log2(*fstop)] = plain_number(key, v, range);
        }
        if (by_stops.empty()) refuse(key, value, range.words);
        if (!fstop_)
            throw UsageError(
                fmt::format("{}: '{}' depends on the f-number, which is unknown: give `fstop`", path_, key));
        const double at = std::log2(*fstop_);
        const auto after = by_stops.lower_bound(at);
        if (after == by_stops.end()) return by_stops.rbegin()->second;
        if (after == by_stops.begin()) return after->second;
        const auto before = std::prev(after);
        const double mixed =
            std::lerp(before->second, after->second, (at - before->first) / (after->first - before->first));
        return range.holds(mixed) ? mixed : before->second; // there are no blades between 0 and 6
    }

    const std::string &path_;
    std::optional<double> fstop_;
};

} // namespace

std::string aperture_named_in(const std::string &lens_file) {
    const Json json = read_json_file(lens_file);
    const auto found = json.is_object() ? json.find("aperture") : json.end();
    return found != json.end() && found->is_string() ? beside(lens_file, found->get<std::string>()) : "";
}

LensFile read_lens_file(const std::string &path, std::optional<double> fstop) {
    return Reader(path, fstop).read();
}

std::map<std::string, std::string> installed_lenses() {
    std::map<std::string, std::string> lenses;
    std::error_code unknown;
    for (const char *folder : {"share/sparselens/lenses", "share/lenses"})
        for (const auto &file : std::filesystem::directory_iterator(find_installed(folder), unknown))
            if (file.path().extension() == ".json")
                lenses.emplace(file.path().stem().string(), file.path().string());
    return lenses;
}

namespace {

std::string lens_file_named(const std::string &name) {
    std::error_code unknown;
    if (std::filesystem::exists(name, unknown) || std::filesystem::path(name).has_parent_path()) return name;
    const auto lenses = installed_lenses();
    const auto lens = lenses.find(name);
    return lens == lenses.end() ? name : lens->second;
}

} // namespace

LensFile read_looks(const GivenLooks &given, std::optional<double> fstop) {
    LensFile lens;
    if (!given.lens_file.empty()) lens = read_lens_file(lens_file_named(given.lens_file), fstop);
    LookValues values = given.values;
    if (!given.aperture_file.empty()) values.picture = read_aperture_picture(given.aperture_file);
    lens.values = look_values_over(values, lens.values);
    return lens;
}

namespace {

// The longest side. Tables of such a picture take 0.5 GB at most. The discs in a picture are smaller, or so far out of
// focus that more pixels would not show.
constexpr int most_pixels = 2048;

// The channels that weigh R, G and B.
std::array<std::size_t, 3> weight_channels(const Image &image, const std::string &path) {
    std::array<std::size_t, 3> rgb = find_rgb(image.channels);
    if (all_found(rgb)) return rgb;
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
