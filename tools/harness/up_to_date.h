// Whether a frame needs no work (-u).
#pragma once

#include <CLI/CLI.hpp>

namespace sparselens {

// Every output that the options name is there, complete, and not older than any file that another option
// names. What the options say else is not looked at: another f-number needs another name, or no -u.
bool is_up_to_date(const CLI::App &parsed);

} // namespace sparselens
