// Prints the options of a tool in other forms than --help.
#pragma once

#include "harness/commands/cli.h"

#include <string>

namespace sparselens {

// A manual page for man(1), in roff: name, synopsis, arguments, options by group, exit status, environment.
std::string man_page(const CLI::App &app, const std::string &version);

// Completion for bash: the options, the words that an option accepts (its type "a|b"), else file names.
std::string bash_completion(const CLI::App &app);

// Completion for zsh (a function _TOOL that is found in $fpath) and for fish, with a description of each option.
std::string zsh_completion(const CLI::App &app);
std::string fish_completion(const CLI::App &app);

// Adds --man and --completion, which print these.
void add_documentation_options(CLI::App &app, const std::string &version);

} // namespace sparselens
