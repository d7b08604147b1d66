#include "loading/notices.h"

#include "deep/checks/view_warnings.h"
#include "deep/front_samples.h"
#include "dof/border_reach.h"
#include "io/files/file_stream.h"
#include "chain/layer_notes.h"

#include <fmt/format.h>

namespace sparselens {

void say_reading(const ToolContext &tool, const std::string &path, const std::vector<std::string> &notes,
                 const std::vector<std::string> &warnings) {
    for (const std::string &note : notes) tool.say(display_name(path) + ": " + note);
    for (const std::string &warning : warnings) warn(tool, display_name(path) + ": " + warning);
}

void say_layers(const ToolContext &tool, const std::string &path, std::span<const Channel> channels) {
    for (const std::string &note : layer_notes(channels)) tool.say(display_name(path) + ": " + note);
}

void say_samples(const ToolContext &tool, const OpenedLdi &in) {
    say_reading(tool, in.name, in.notes, in.warnings);
    say_layers(tool, in.name, in.ldi.channels);
    if (in.coverage_by_colour) tool.say(in.name + ": each colour has its own coverage (AR, AG, AB)");
}

void warn_of(const ToolContext &tool, const std::vector<std::string> &warnings) {
    for (const std::string &warning : warnings) warn(tool, warning);
}

void warn_of_flat_picture(const ToolContext &tool, const OpenedLdi &in) {
    if (in.deep) return;
    warn_of(tool, picture_warnings(front_view(in.ldi, in.name),
                                   {in.depth, in.depth_filtered, in.camera, in.unpremultiplied}));
}

void say_border_reach(const ToolContext &tool, const std::string &path, const Ldi &ldi, const ThinLens &lens,
                      int across, const LensLooks &looks) {
    const BorderReach reach = border_reach(ldi, lens, looks);
    if (reach.needed == 0) return;
    const std::string text =
        fmt::format("{}: the blur reaches {} pixels beyond the frame, and {} were rendered there",
                    display_name(path), pieces_of(reach.needed, across), reach.rendered / across);
    const bool can_be_rendered = reach.needed <= ldi.windows.display_width(); // else depths or lens are wrong
    if (reach.too_little() && reach.bright && can_be_rendered)
        warn_once(tool, "overscan",
                  text + "; discs of lights outside the frame are missing, so render more overscan");
    else
        tool.say(text);
}

void say_camera(const ToolContext &tool, const std::string &path, const Camera &camera) {
    for (const std::string &found : camera.found) tool.say(display_name(path) + ": " + found);
    for (const auto &[parameter, reason] : camera.unsure)
        tool.say(display_name(path) + ": " + reason + "; `" + parameter + "` settles it");
}

void warn_of_clamped(const ToolContext &tool, const std::string &path, std::size_t clamped) {
    if (clamped > 0)
        warn(tool, fmt::format("{}: {} values beyond the range of half are clamped to 65504",
                               display_name(path), clamped));
}

void warn_of_invalid_values(const ToolContext &tool, const std::string &path, const InvalidValues &bad) {
    if (bad.any()) warn(tool, display_name(path) + ": " + bad.text());
}

} // namespace sparselens
