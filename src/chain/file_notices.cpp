#include "chain/file_notices.h"

#include "base/grid.h"
#include "dof/border_reach.h"
#include "io/files/file_stream.h"
#include "view/speckles.h"

#include <fmt/format.h>

#include <algorithm>

namespace sparselens {

namespace {

const char *fate_of(const Channel &channel) {
    if (is_in_matte(channel)) return "Cryptomatte: ids are copied, their coverage goes through the lens";
    if (holds_ids(channel)) return "ids: those of the front sample, never averaged";
    if (is_light(channel)) return "light: goes through the lens";
    return "data: averaged as light is, but no highlight and no colour";
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

void tell_reading(const Tell &tell, const std::string &path, const std::vector<std::string> &notes,
                  const std::vector<std::string> &warnings) {
    for (const std::string &note : notes) tell({NoticeKind::file_note, display_name(path), {note}});
    for (const std::string &warning : warnings)
        tell({NoticeKind::file_warning, display_name(path), {warning}});
}

void tell_layers(const Tell &tell, const std::string &path, std::span<const Channel> channels) {
    for (const std::string &note : layer_notes(channels))
        tell({NoticeKind::file_note, display_name(path), {note}});
}

void tell_samples(const Tell &tell, const OpenedLdi &in) {
    tell_reading(tell, in.name, in.notes, in.warnings);
    tell_layers(tell, in.name, in.ldi.channels);
    tell_speckles(tell, in.name, in.speckles);
    if (in.coverage_by_colour) tell({NoticeKind::coverage_by_colour, in.name});
    tell_invalid_values(tell, in.name, in.bad);
}

void tell_speckles(const Tell &tell, const std::string &path, std::size_t speckles) {
    if (speckles > 0) tell({NoticeKind::speckles, display_name(path), {speckle_warning(speckles)}});
}

void tell_camera(const Tell &tell, const std::string &path, const Camera &camera) {
    for (const std::string &found : camera.found) tell({NoticeKind::camera, display_name(path), {found}});
    for (const auto &[parameter, reason] : camera.unsure)
        tell({NoticeKind::camera_unsure, display_name(path), {reason}, parameter});
}

void tell_warnings(const Tell &tell, const std::vector<std::string> &warnings) {
    for (const std::string &warning : warnings)
        tell({.kind = NoticeKind::picture_warning, .values = {warning}});
}

void tell_border_reach(const Tell &tell, const std::string &path, const Ldi &ldi, const ThinLens &lens,
                       int across, const LensLooks &looks) {
    const BorderReach reach = border_reach(ldi, lens, looks);
    if (reach.needed == 0) return;
    const bool can_be_rendered = reach.needed <= ldi.windows.display_width(); // else depths or lens are wrong
    const bool missing = reach.too_little() && reach.bright && can_be_rendered;
    tell({missing ? NoticeKind::missing_overscan : NoticeKind::overscan,
          display_name(path),
          {double(pieces_of(reach.needed, across)), double(reach.rendered / across)}});
}

void tell_clamped(const Tell &tell, const std::string &path, std::size_t clamped) {
    if (clamped > 0) tell({NoticeKind::clamped, display_name(path), {clamped}});
}

void tell_invalid_values(const Tell &tell, const std::string &path, const InvalidValues &bad) {
    if (bad.any()) tell({NoticeKind::file_warning, display_name(path), {bad.text()}});
}

} // namespace sparselens
