// The command line of dof-match, and its answers as JSON.
#pragma once

#include "chain/gather_windows.h"
#include "chain/match_lens.h"
#include "harness/commands/cli.h"
#include "harness/progress_lines.h"

#include <nlohmann/json.hpp>

#include <string>

namespace sparselens {

struct MatchCommand : LdiRequest { // with the options that say how to read the LDI
    std::string plate, output, show, frames, stats;
    bool json = false, shape = false;
    ProgressFormat progress = ProgressFormat::terminal;
    MatchRequest match;
};

// `options` must not move until the command line is parsed.
void add_match_options(CLI::App &app, MatchCommand &options);

// A matched lens as JSON, with infinity as "inf": for programs that run dof-match, and for the page of dof-view.
nlohmann::ordered_json as_json(const MatchedLens &lens);
nlohmann::ordered_json as_json(const MatchedShape &shape);

// A number that JSON can hold, else "inf".
nlohmann::ordered_json finite_json(double value);

} // namespace sparselens
