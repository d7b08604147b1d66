#include "chain/recoloured.h"

#include "chain/file_notices.h"

#include <cstddef>

namespace sparselens {

void recolor_by(const Beauty &beauty, OpenedLdi &ldi, const Tell &tell) {
    tell_reading(tell, beauty.name, beauty.notes, beauty.warnings);
    tell_invalid_values(tell, beauty.name, beauty.bad);
    const std::size_t notes = ldi.notes.size();
    tell_warnings(tell, recolor(ldi, beauty));
    for (std::size_t i = notes; i < ldi.notes.size(); ++i)
        tell({NoticeKind::file_note, beauty.name, {ldi.notes[i]}});
    tell_layers(tell, beauty.name, ldi.ldi.channels);
}

void recolor_by(const std::string &path, const PictureChoice &choice, const ColourOptions &colour,
                OpenedLdi &ldi, const Tell &tell) {
    if (path.empty()) return;
    tell({NoticeKind::reading, path});
    Beauty beauty = open_beauty(path, choice);
    beauty.header = to_linear(tell, colour, path, beauty.header, beauty.image);
    recolor_by(beauty, ldi, tell);
}

} // namespace sparselens
