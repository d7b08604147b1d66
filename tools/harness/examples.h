// Examples of a command line, shown at the end of --help and in the manual page. tests/tools/examples.sh runs them.
#pragma once

#include "harness/commands/cli.h"

#include <initializer_list>
#include <string>

namespace sparselens {

struct Example {
    const char *purpose; // a sentence without its full stop
    const char *command; // as typed, in one line
};

void add_examples(CLI::App &app, std::initializer_list<Example> examples);

// The examples of `app` as text, two lines each, without the heading; empty if it has none.
std::string examples_text(const CLI::App &app);

} // namespace sparselens
