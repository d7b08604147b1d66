// Whether a frame needs no work (-u).
#pragma once

#include "harness/commands/named_files.h"

#include <string>

namespace sparselens {

enum class Freshness {
    stale, // work is needed
    fresh, // every output exists, is complete, is not older than any input, and was made by this command
    not_compared, // the same, but the command that made it is unknown: an output has no history, or none was asked for
};

// `command_line` is the frame's (history.h) and begins with the name of the tool; empty: it is not compared.
Freshness freshness_of(const NamedFiles &files, const std::string &command_line);

} // namespace sparselens
