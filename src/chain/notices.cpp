#include "chain/notices.h"

#include "base/grid.h"
#include "dof/border_reach.h"
#include "finish/lens_check.h"
#include "io/camera/camera_header.h"
#include "io/files/file_stream.h"
#include "view/flat_pixels.h"

#include <fmt/args.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

namespace sparselens {

namespace {

using enum NoticeLevel;

struct Words {
    NoticeKind kind;
    NoticeLevel level;
    const char *text;
};

constexpr std::array table{
    Words{NoticeKind::reading, note, "reading {file}"},
    Words{NoticeKind::file_note, note, "{file}: {0}"},
    Words{NoticeKind::file_warning, warning, "{file}: {0}"},
    Words{NoticeKind::coverage_by_colour, note, "{file}: each colour has its own coverage (AR, AG, AB)"},
    Words{NoticeKind::speckles, once,
          "{file}: {0}; if it is smoke or fog, render it by itself (docs/renderers.md, \"Smoke and fog\"; in "
          "Blender, --slices 8)"},
    Words{NoticeKind::clamped, warning, "{file}: {0} values beyond the range of half are clamped to 65504"},
    Words{NoticeKind::camera, note, "{file}: {0}"},
    Words{NoticeKind::camera_unsure, note, "{file}: {0}; `{parameter}` settles it"},
    Words{NoticeKind::colour_space, note, "{file}: colour space {0}"},
    Words{NoticeKind::unnamed_chromaticities, warning,
          "{file}: the colour configuration has no space with its chromaticities, so its colours are taken "
          "for scene-linear; if they are not, give `{parameter}`"},
    Words{NoticeKind::unnamed_space, warning,
          "{file}: the colour configuration has no space for its {0}, so its colours are taken for "
          "scene-linear; if they are not, give `{parameter}`"},
    Words{NoticeKind::no_colorconfig, warning,
          "{0}; EXR is taken as linear: correct $OCIO, or name a configuration by `{parameter}`"},
    Words{NoticeKind::displayed, note, "{file}: written with a display transform"},
    Words{NoticeKind::dropped_alpha, once,
          "{file}: the format has no alpha, so the picture lies over black: PNG and TIFF keep its alpha"},
    Words{NoticeKind::converted, warning,
          "{file}: its colours are in another space than those of {0}, and are converted"},
    Words{NoticeKind::changed_data, warning,
          "{file}: its compression is for colours, and changes the data of channel {0}: give "
          "`{parameter}=zip`"},
    Words{NoticeKind::picture_warning, warning, "{0}"},
    Words{NoticeKind::coverage_differs, warning,
          "{file}: its coverage differs from that of {0} in {1} of {2} pixels; render both with the same "
          "objects and pixel filter. Coverage that it alone has lies at infinity"},
    Words{NoticeKind::without_colours, warning,
          "{file}: has no colours for {1} pixels of {0}, which are left out: render as much overscan as {0} "
          "has"},
    Words{NoticeKind::light_at_infinity, note,
          "{file}: {0} pixels have light or coverage without a sample; it lies at infinity"},
    Words{NoticeKind::regions, note,
          "the regions are those of a lens of radius {0:g}, focal length {1:g} pixels, focused at {2:g}"},
    Words{NoticeKind::framing, note,
          "{file}: optical axis {0:g},{1:g} pixels from that of the centre view, focal length {2:g} times "
          "that of the centre view, {3:g} scene units in front of it"},
    Words{NoticeKind::warped, note, "{0} views, {1} samples in {2} pixels"},
    Words{NoticeKind::clustered, note, "{0} samples to {1}, CoC changed by at most {2:.6f} px"},
    Words{NoticeKind::clustered_blindly, note,
          "{0} samples to {1}, by inverse depth alone, because the lens is unknown"},
    Words{NoticeKind::focused, note, "the focus distance is {0:g}, the depth of pixel {1:g},{2:g}"},
    Words{NoticeKind::usual_focus, once,
          "{file}: the focus is on pixel {0:g},{1:g}, the nearest large thing near the middle; `focus_pixel` "
          "chooses another"},
    Words{NoticeKind::used_lens, note,
          "the picture is that of a lens of radius {0:g}, focal length {1:g} pixels, focused at {2:g}"},
    Words{NoticeKind::wide_lens, warning,
          "the aperture is larger than the one that the views were rendered for; parts of the picture are "
          "unknown"},
    Words{NoticeKind::round_aperture, warning, "method {0} ignores the aperture's shape, and takes a disc"},
    Words{NoticeKind::overscan, note,
          "{file}: the blur reaches {0} pixels beyond the frame, and {1} were rendered there"},
    Words{
        NoticeKind::missing_overscan, once,
        "{file}: the blur reaches {0} pixels beyond the frame, and {1} were rendered there; discs of lights "
        "outside the frame are missing, so render more overscan"},
    Words{
        NoticeKind::too_much_blur, once,
        "{file}: the blur reaches {0} pixels beyond the frame, which is farther than it is wide, so the lens "
        "sees little that is known: check the aperture, the focus and the unit of the scene"},
    Words{NoticeKind::flicker, warning,
          "{file}: its depth flickers: where the picture stands still, half of the pixels change their blur "
          "by {0:.1f} pixels or more since the frame before"},
    Words{NoticeKind::on_cpu, note, "device: the CPU"},
    Words{NoticeKind::on_device, note, "device: {0}"},
    Words{NoticeKind::no_vulkan, note, "Vulkan finds no device: {0}"},
    Words{NoticeKind::gather_unusable, warning, "{0}; the CPU gathers"},
    Words{NoticeKind::gather_failed, warning, "{0}; the CPU gathers the remaining tiles"},
    Words{NoticeKind::gathered_tiles, note, "tiles gathered by the device: {0} of {1}"},
    Words{NoticeKind::left_tiles, note, "tiles gathered by the CPU: {0} ({1})"},
    Words{NoticeKind::warp_unusable, warning, "{0}; the CPU warps"},
    Words{NoticeKind::warp_failed, warning, "{0}; the CPU warps the remaining rows"},
    Words{NoticeKind::warped_rows, note, "rows warped by the device: {0} of {1}"},
    Words{NoticeKind::left_rows, note, "rows warped by the CPU: {0} ({1})"},
    Words{NoticeKind::uploaded, note, "uploaded to the device: {0:.1f} MB"},
};

constexpr bool in_order() {
    for (std::size_t i = 0; i < table.size(); ++i)
        if (table[i].kind != NoticeKind(i)) return false;
    return table.size() == std::size_t(NoticeKind::uploaded) + 1;
}
static_assert(in_order());

const Words &words_for(const Notice &notice) { return table[std::size_t(notice.kind)]; }

} // namespace

NoticeLevel level_of(const Notice &notice) { return words_for(notice).level; }

// The texts number their values, because newer versions of fmt do not mix names with `{}`.
std::string words_of(const Notice &notice) {
    fmt::dynamic_format_arg_store<fmt::format_context> values;
    for (const Notice::Value &value : notice.values)
        std::visit([&](const auto &one) { values.push_back(one); }, value);
    values.push_back(fmt::arg("file", notice.file));
    values.push_back(fmt::arg("parameter", notice.parameter));
    return fmt::vformat(words_for(notice).text, values);
}

namespace {

const char *fate_of(const Channel &channel) {
    if (is_in_matte(channel)) return "Cryptomatte: ids are copied, the lens blurs their coverage";
    if (holds_ids(channel)) return "ids: those of the front sample, never averaged";
    if (is_light(channel)) return "light: the lens blurs it";
    return "data: averaged like light, without highlights and colour management";
}

struct Layer {
    std::string name;
    const char *fate;
    bool operator==(const Layer &) const = default;
};

Layer layer_of(const Channel &channel) {
    const std::size_t dot = channel.name.rfind('.');
    const bool plain = dot == std::string::npos;
    const std::string name = is_in_matte(channel) ? channel.matte : channel.name.substr(0, plain ? 0 : dot);
    return {plain && !is_light(channel) ? channel.name : name, fate_of(channel)};
}

} // namespace

std::vector<std::string> layer_notes(std::span<const Channel> channels) {
    std::vector<Layer> layers;
    for (const Channel &channel : channels)
        if (Layer layer = layer_of(channel); std::ranges::find(layers, layer) == layers.end())
            layers.push_back(std::move(layer));
    std::vector<std::string> notes;
    for (const Layer &layer : layers)
        notes.push_back(
            fmt::format("layer {}: {}", layer.name.empty() ? "of the picture" : layer.name, layer.fate));
    return notes;
}

void notify_reading(const Notify &notify, const std::string &path, const std::vector<std::string> &notes,
                    const std::vector<std::string> &warnings) {
    for (const std::string &note : notes) notify({NoticeKind::file_note, display_name(path), {note}});
    for (const std::string &warning : warnings)
        notify({NoticeKind::file_warning, display_name(path), {warning}});
}

void notify_layers(const Notify &notify, const std::string &path, std::span<const Channel> channels) {
    for (const std::string &note : layer_notes(channels))
        notify({NoticeKind::file_note, display_name(path), {note}});
}

void notify_samples(const Notify &notify, const OpenedLdi &in) {
    notify_reading(notify, in.name, in.notes, in.warnings);
    notify_layers(notify, in.name, in.ldi.channels);
    notify_speckles(notify, in.name, in.speckles);
    if (in.coverage_by_colour) notify({NoticeKind::coverage_by_colour, in.name});
    notify_invalid_values(notify, in.name, in.bad);
}

void notify_speckles(const Notify &notify, const std::string &path, std::size_t speckles) {
    if (speckles > 0) notify({NoticeKind::speckles, display_name(path), {speckle_warning(speckles)}});
}

void notify_camera(const Notify &notify, const std::string &path, const Camera &camera) {
    for (const std::string &found : camera.found) notify({NoticeKind::camera, display_name(path), {found}});
    for (const auto &[parameter, reason] : camera.unsure)
        notify({NoticeKind::camera_unsure, display_name(path), {reason}, parameter});
}

void notify_warnings(const Notify &notify, const std::vector<std::string> &warnings) {
    for (const std::string &warning : warnings)
        notify({.kind = NoticeKind::picture_warning, .values = {warning}});
}

void notify_other_lens(const Notify &notify, const Imf::Header &gathered, const Imf::Header &render,
                       const std::string &path) {
    Camera lens = read_camera(gathered);
    if (lens.fstop && !lens.looks.blades) lens.looks.blades = 0; // dof-gather writes the blades it draws
    if (const auto other = lens_differences(lens, read_camera(render)); !other.empty())
        notify({NoticeKind::file_warning,
                display_name(path),
                {fmt::format("another lens or camera than that of the gathered picture: {}",
                             fmt::join(other, "; "))}});
}

void notify_border_reach(const Notify &notify, const std::string &path, const Ldi &ldi, const ThinLens &lens,
                         int across, const LensLooks &looks) {
    const BorderReach reach = border_reach(ldi, lens, looks);
    if (reach.needed == 0) return;
    const bool missing = reach.too_little() && reach.bright;
    notify({reach.needed > ldi.windows.display_width() ? NoticeKind::too_much_blur
            : missing                                  ? NoticeKind::missing_overscan
                                                       : NoticeKind::overscan,
            display_name(path),
            {double(pieces_of(reach.needed, across)), double(reach.rendered / across)}});
}

void notify_clamped(const Notify &notify, const std::string &path, std::size_t clamped) {
    if (clamped > 0) notify({NoticeKind::clamped, display_name(path), {clamped}});
}

void notify_invalid_values(const Notify &notify, const std::string &path, const InvalidValues &bad) {
    if (bad.any()) notify({NoticeKind::file_warning, display_name(path), {bad.text()}});
}

} // namespace sparselens
