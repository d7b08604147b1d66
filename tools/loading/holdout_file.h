// The deep picture that holds another out.
#pragma once

#include "deep/ldi.h"
#include "io/open_options.h"

#include <optional>
#include <string>

namespace sparselens {

// Empty if the path is empty. The picture is reduced by `proxy_factor`. Throws Error if its display window differs from
// that of `windows`.
std::optional<Ldi> open_holdout(const std::string &path, const Windows &windows, int proxy_factor,
                                const OpenOptions &options);

} // namespace sparselens
