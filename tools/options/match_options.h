// The command line of dof-match.
#pragma once

#include "chain/ldi_cache.h"
#include "chain/match_lens.h"
#include "harness/commands/cli.h"

#include <string>

namespace sparselens {

struct MatchCommand : LdiRequest { // with the options that say how to read the LDI
    std::string plate, output, show, frames, stats;
    bool json = false, shape = false;
    MatchRequest match;
};

// `options` must not move until the command line is parsed.
void add_match_options(CLI::App &app, MatchCommand &options);

} // namespace sparselens
