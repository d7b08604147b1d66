#include "chain/same_shutter.h"

#include "base/error.h"
#include "io/moment_files.h"

#include <ImfStandardAttributes.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace sparselens {

namespace {

// The focal length and the radius of a lens may change by this factor while a shutter is open, in a fast zoom.
constexpr double most_change = 1.25;

bool is_far_from(double one, double other) {
    return std::max(one, other) > most_change * std::min(one, other);
}

std::string size_of(const Windows &windows) {
    return fmt::format("{}x{}", windows.display_width(), windows.display_height());
}

std::optional<Imf::Chromaticities> chromaticities_of(const Imf::Header &header) {
    return Imf::hasChromaticities(header) ? std::optional(Imf::chromaticities(header)) : std::nullopt;
}

[[noreturn]] void refuse(const std::string &first, const std::string &other, const std::string &what) {
    throw Error(fmt::format("{}: {} than {}; the moments of a shutter are of one shot", other, what, first));
}

} // namespace

void require_same_size(const NamedWindows &first, const NamedWindows &other) {
    const Windows &size = first.windows, &others = other.windows;
    if (size.display != others.display)
        refuse(first.name, other.name, fmt::format("its size of {} is another", size_of(others)));
    if (size.pixel_aspect != others.pixel_aspect)
        refuse(first.name, other.name,
               fmt::format("its pixel aspect of {:g} is another", others.pixel_aspect));
}

void require_same_shutter(const NamedPicture &first, const NamedPicture &other) {
    const TakenPicture &a = first.picture, &b = other.picture;
    require_same_size({first.name, a.image.windows}, {other.name, b.image.windows});
    const auto refused = [&](const std::string &what) { refuse(first.name, other.name, what); };
    if (a.image.channels != b.image.channels) refused("it has other channels");
    if (chromaticities_of(a.header) != chromaticities_of(b.header)) refused("it is in another colour space");
    if (is_far_from(a.lens.focal_px, b.lens.focal_px))
        refused(fmt::format("its focal length of {:g} pixels is another", b.lens.focal_px));
    if (is_far_from(a.lens.radius, b.lens.radius))
        refused(fmt::format("its lens radius of {:g} is another", b.lens.radius));
}

void require_moment(const NamedPicture &one, std::size_t moment, std::size_t moments) {
    const auto stated = stated_moment(one.picture.header);
    if (!stated) return;
    if (stated->moments != int(moments))
        throw Error(
            fmt::format("{}: is one of {} moments, and there are {}", one.name, stated->moments, moments));
    if (stated->moment != int(moment))
        throw Error(fmt::format("{}: is moment {} of its shutter, and the files have it as moment {}",
                                one.name, stated->moment, moment));
}

} // namespace sparselens
