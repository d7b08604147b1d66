#include "loading/holdout_file.h"

#include "io/open_ldi.h"

namespace sparselens {

std::optional<Ldi> open_holdout(const std::string &path, const OpenedLdi &ldi, const WindowOptions &windows,
                                const OpenOptions &options) {
    if (path.empty()) return {};
    const OpenedLdi in = open_ldi(path, options);
    return holdout_for(ldi, windows, in.ldi, in.name);
}

} // namespace sparselens
