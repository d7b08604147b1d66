#include "chain/words.h"

#include <fmt/args.h>
#include <fmt/format.h>

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
    Words{NoticeKind::file_note, note, "{file}: {}"},
    Words{NoticeKind::file_warning, warning, "{file}: {}"},
    Words{NoticeKind::coverage_by_colour, note, "{file}: each colour has its own coverage (AR, AG, AB)"},
    Words{NoticeKind::speckles, once,
          "{file}: {}; if it is smoke or fog, render it by itself (docs/renderers.md, \"Smoke and fog\"; in "
          "Blender, --slices 8)"},
    Words{NoticeKind::clamped, warning, "{file}: {} values beyond the range of half are clamped to 65504"},
    Words{NoticeKind::camera, note, "{file}: {}"},
    Words{NoticeKind::camera_unsure, note, "{file}: {}; `{parameter}` settles it"},
    Words{NoticeKind::colour_space, note, "{file}: colour space {}"},
    Words{
        NoticeKind::unnamed_chromaticities, warning,
        "{file}: its chromaticities are of no colour space that the colour configuration names; its colours "
        "are taken for scene-linear: give `{parameter}`"},
    Words{
        NoticeKind::unnamed_space, warning,
        "{file}: its {} is of no colour space that the colour configuration names; its colours are taken for "
        "scene-linear: give `{parameter}`"},
    Words{NoticeKind::no_colorconfig, warning,
          "{}; EXR is taken as linear: mend $OCIO, or name a configuration by `{parameter}`"},
    Words{NoticeKind::displayed, note, "{file}: written with a display transform"},
    Words{NoticeKind::picture_warning, warning, "{}"},
    Words{
        NoticeKind::coverage_differs, warning,
        "{file}: its coverage differs from that of {} in {} of {} pixels; render both with the same objects "
        "and pixel filter. What it alone covers lies at infinity"},
    Words{NoticeKind::without_colours, warning,
          "{file}: has no colours for {1} pixels of {0}, which are left out; render as much overscan as that "
          "has"},
    Words{NoticeKind::light_at_infinity, note,
          "{file}: {} pixels show light or coverage at infinity, where no sample is"},
    Words{NoticeKind::regions, note,
          "the regions are those of a lens of radius {:g}, focal length {:g} pixels, focused at {:g}"},
    Words{
        NoticeKind::framing, note,
        "{file}: optical axis {:g},{:g} pixels from that of the centre view, focal length {:g} times that of "
        "the centre view, {:g} scene units in front of it"},
    Words{NoticeKind::warped, note, "{} views, {} samples in {} pixels"},
    Words{NoticeKind::clustered, note, "{} samples to {}, CoC changed by at most {:.6f} px"},
    Words{NoticeKind::clustered_blindly, note,
          "{} samples to {}, by inverse depth alone, because the lens is unknown"},
    Words{NoticeKind::focused, note, "the focus distance is {:g}, the depth of pixel {:g},{:g}"},
    Words{NoticeKind::wide_lens, warning,
          "the aperture is larger than the one the views were rendered for; what it sees beyond them is "
          "unknown"},
    Words{NoticeKind::round_aperture, warning, "method {} ignores the aperture's shape; using a disc"},
    Words{NoticeKind::overscan, note,
          "{file}: the blur reaches {} pixels beyond the frame, and {} were rendered there"},
    Words{NoticeKind::missing_overscan, once,
          "{file}: the blur reaches {} pixels beyond the frame, and {} were rendered there; discs of lights "
          "outside the frame are missing, so render more overscan"},
    Words{NoticeKind::on_cpu, note, "device: the CPU"},
    Words{NoticeKind::on_device, note, "device: {}"},
    Words{NoticeKind::no_vulkan, note, "no device by Vulkan: {}"},
    Words{NoticeKind::gather_unusable, warning, "{}; the CPU gathers"},
    Words{NoticeKind::gather_failed, warning, "{}; the CPU gathers what it has not"},
    Words{NoticeKind::gathered_tiles, note, "tiles gathered by the device: {} of {}"},
    Words{NoticeKind::left_tiles, note, "tiles gathered by the CPU: {} ({})"},
    Words{NoticeKind::warp_unusable, warning, "{}; the CPU warps"},
    Words{NoticeKind::warp_failed, warning, "{}; the CPU warps what it has not"},
    Words{NoticeKind::warped_rows, note, "rows warped by the device: {} of {}"},
    Words{NoticeKind::left_rows, note, "rows warped by the CPU: {} ({})"},
    Words{NoticeKind::uploaded, note, "uploaded to the device: {:.1f} MB"},
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

std::string words_of(const Notice &notice) {
    fmt::dynamic_format_arg_store<fmt::format_context> values;
    for (const Notice::Value &value : notice.values)
        std::visit([&](const auto &one) { values.push_back(one); }, value);
    values.push_back(fmt::arg("file", notice.file));
    values.push_back(fmt::arg("parameter", notice.parameter));
    return fmt::vformat(words_for(notice).text, values);
}

} // namespace sparselens
