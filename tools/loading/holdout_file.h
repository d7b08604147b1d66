// The deep picture that holds another out.
#pragma once

#include "deep/holdout.h"
#include "io/open_options.h"

#include <optional>
#include <string>

namespace sparselens {

// None where the path is empty. Made a proxy. Error: its display window is not `windows`'.
std::optional<Holdout> open_holdout(const std::string &path, const Windows &windows, int proxy_factor,
                                    const OpenOptions &options);

} // namespace sparselens
