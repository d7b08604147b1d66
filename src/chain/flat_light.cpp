#include "chain/flat_light.h"

#include "chain/file_notices.h"
#include "deep/sanitize.h"
#include "io/files/file_stream.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace sparselens {

namespace {

// Drops everything else, such as depths at infinity.
Image light_and_coverage(const Image &image) {
    std::vector<Channel> kept;
    std::ranges::copy_if(image.channels, std::back_inserter(kept), is_light);
    Image result(image.windows, kept);
    for (std::size_t k = 0; k < kept.size(); ++k)
        std::ranges::copy(image.plane(find_channel(image.channels, kept[k].name)), result.plane(k).begin());
    return result;
}

} // namespace

FlatLight light_of(FlatFile file, const std::string &path, const ColourOptions *colour, const Tell &tell) {
    const std::string name = display_name(path);
    // Every pixel is placed in front of the camera, so that its values are repaired like those of a view.
    View view{name, light_and_coverage(file.image), {}};
    view.z.assign(view.image.windows.pixels(), 1);
    const InvalidValues bad = sanitize(view);
    tell_reading(tell, name, file.notes, file.warnings);
    tell_invalid_values(tell, name, bad);
    FlatLight light{name, std::move(view.image), std::move(file.header)};
    if (colour) light.header = to_linear(tell, *colour, path, light.header, light.image);
    return light;
}

PictureChoice without_depth(PictureChoice choice) {
    choice.depth.clear();
    choice.depth_file.clear();
    return choice;
}

FlatLight open_light(const std::string &path, const PictureChoice &choice, const ColourOptions *colour,
                     const Tell &tell) {
    tell({NoticeKind::reading, path});
    return light_of(read_flat_exr(path, without_depth(choice)), path, colour, tell);
}

} // namespace sparselens
