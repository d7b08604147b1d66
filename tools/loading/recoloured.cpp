#include "loading/recoloured.h"

#include "io/recolor_ldi.h"
#include "loading/notices.h"

#include <cstddef>

namespace sparselens {

void recolor_by(const ToolContext &tool, const std::string &path, const PictureChoice &choice,
                const ColourOptions &colour, OpenedLdi &ldi) {
    if (path.empty()) return;
    tool.say("reading " + path);
    Beauty beauty = open_beauty(path, choice);
    say_reading(tool, beauty.name, beauty.notes, beauty.warnings);
    warn_of_invalid_values(tool, path, beauty.bad);
    beauty.header = to_linear(tool, colour, path, beauty.header, beauty.image);
    const std::size_t notes = ldi.notes.size();
    warn_of(tool, recolor(ldi, beauty));
    for (std::size_t i = notes; i < ldi.notes.size(); ++i) tool.say(beauty.name + ": " + ldi.notes[i]);
    say_layers(tool, beauty.name, ldi.ldi.channels);
}

} // namespace sparselens
