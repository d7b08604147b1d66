#include "loading/holdout_file.h"

#include "base/error.h"
#include "deep/proxy.h"
#include "io/open_ldi.h"

namespace sparselens {

std::optional<Ldi> open_holdout(const std::string &path, const Windows &windows, int proxy_factor,
                                const OpenOptions &options) {
    if (path.empty()) return {};
    OpenedLdi in = open_ldi(path, options);
    if (in.ldi.windows.display != windows.display)
        throw Error(in.name + ": its display window differs from that of the picture it holds out; use a "
                              "holdout of the same size");
    return proxy_factor == 1 ? std::move(in.ldi) : proxy(in.ldi, proxy_factor);
}

} // namespace sparselens
