#include "lab/averaging/lens_view_files.h"

#include "base/error.h"
#include "io/camera/camera_header.h"
#include "io/exr/exr_common.h"
#include "options/picture_options.h"
#include "view/view_mapping.h"

namespace sparselens {

namespace {

// Reads the header of a view; from standard input, which can be read only once, the pixels too.
Imf::Header open_header(LensViewFile &view) {
    if (view.path != "-") return read_flat_header(view.path, view.picture);
    view.pixels = read_flat_exr(view.path, view.picture);
    return view.pixels->header;
}

void place_by_metadata(std::span<LensViewFile> views, const std::vector<Imf::Header> &headers,
                       const std::string &centre_file, LensViewFiles &result) {
    std::vector<Camera> cameras;
    std::vector<std::string> names;
    for (std::size_t i = 0; i < views.size(); ++i) {
        cameras.push_back(read_camera(headers[i]));
        names.push_back(views[i].path);
    }
    std::optional<Camera> centre;
    if (!centre_file.empty()) {
        centre = result.centre;
        if (!centre->world_to_camera)
            throw UsageError(centre_file +
                             ": there is no worldToCamera attribute, so the place of its camera is unknown");
    }
    const LensViews placed = position_on_lens(cameras, names, centre);
    require_one_plane(placed, names);
    for (std::size_t i = 0; i < views.size(); ++i) views[i].position = placed.positions[i];
    result.centre = placed.centre;
    result.centre_guessed = placed.centre_guessed;
}

// Reads lens shifts from the files, however the views' positions are given: converging views have shifted frusta.
void find_shifts(const std::vector<Imf::Header> &headers, bool centre_is_known, LensViewFiles &result) {
    Imath::V2d sum(0, 0);
    for (std::size_t i = 0; i < result.views.size(); ++i) {
        const Framing framing =
            framing_relative_to(result.centre, read_camera(headers[i]), result.views[i].path);
        const Imath::V2d centre = result.centre.principal_point.value_or(Imath::V2d(0, 0));
        Imath::V2d &shift = result.views[i].shift;
        shift = in_pixels(centre, result.windows) - in_pixels(framing.principal_point, result.windows);
        sum += shift;
    }
    if (centre_is_known) return;
    for (LensViewFile &view : result.views) view.shift -= sum / double(result.views.size());
}

} // namespace

FlatFile LensViewFile::take_pixels() { return pixels ? std::move(*pixels) : read_flat_exr(path, picture); }

LensViewFiles open_lens_views(const LensViewOptions &options) {
    LensViewFiles result;
    for (const std::string &path : options.files)
        result.views.push_back({path, {0, 0}, {0, 0}, {}, options.picture});
    for (const auto &[position, path] : options.placed)
        result.views.push_back({path, view_offset(position), {0, 0}, {}, options.picture});
    if (result.views.empty()) throw UsageError("no views are given; name their files");
    std::vector<Imf::Header> headers;
    for (LensViewFile &view : result.views) headers.push_back(open_header(view));
    result.windows = windows_of(headers.front());
    for (std::size_t i = 0; i < headers.size(); ++i)
        if (headers[i].displayWindow() != result.windows.display)
            throw Error(result.views[i].path + ": the display window differs from that of " +
                        result.views[0].path);
    result.header =
        options.centre.empty() ? headers.front() : read_flat_header(options.centre, options.picture);
    result.centre = read_camera(result.header);
    if (!options.files.empty())
        place_by_metadata(std::span(result.views).first(options.files.size()), headers, options.centre,
                          result);
    find_shifts(headers, !options.centre.empty() || !options.files.empty(), result);
    return result;
}

} // namespace sparselens
