#include "loading/holdout_file.h"

#include "io/open_ldi.h"

namespace sparselens {

std::optional<Ldi> open_holdout(const std::string &path, const OpenedLdi &ldi, const WindowOptions &windows,
                                const OpenOptions &options) {
    if (path.empty()) return {};
    OpenOptions by = options;
    by.depth.picture.depth_file.clear(); // of the picture
    const OpenedLdi in = open_ldi(path, by);
    return holdout_for(ldi, windows, in.ldi, in.name);
}

} // namespace sparselens
