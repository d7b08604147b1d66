// The deep picture that holds another out.
#pragma once

#include "deep/ldi.h"
#include "chain/gather_windows.h"

#include <optional>
#include <string>

namespace sparselens {

// Empty if the path is empty, else as holdout_for() has it (chain/gather_windows.h).
std::optional<Ldi> open_holdout(const std::string &path, const OpenedLdi &ldi, const WindowOptions &windows,
                                const OpenOptions &options);

} // namespace sparselens
