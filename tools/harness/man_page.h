// The options of a tool, which --help prints, in other forms.
#pragma once

#include "harness/commands/cli.h"

#include <string>

namespace sparselens {

// A manual page for man(1), in roff: name, synopsis, arguments, options by group, exit status, environment.
std::string man_page(const CLI::App &app, const std::string &version);

// For bash: the options, the words that an option takes (its type "a|b"), else file names.
std::string bash_completion(const CLI::App &app);

// The same for zsh (a function _TOOL that is found in $fpath) and for fish, with a description of each option.
std::string zsh_completion(const CLI::App &app);
std::string fish_completion(const CLI::App &app);

// Adds --man and --completion, which print them.
void add_documentation_options(CLI::App &app, const std::string &version);

} // namespace sparselens
