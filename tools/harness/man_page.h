// The option table of a tool, as --help prints it, in further forms.
#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace sparselens {

// For man(1), in roff: name, synopsis, arguments, options by group, exit status, environment.
std::string man_page(const CLI::App &app, const std::string &version);

// For bash: the options, the words that an option takes (its type "a|b"), else file names.
std::string bash_completion(const CLI::App &app);

// For zsh (a function _TOOL that $fpath finds) and for fish: the same, with what each option is for.
std::string zsh_completion(const CLI::App &app);
std::string fish_completion(const CLI::App &app);

// --man and --completion, which print them.
void add_documentation_options(CLI::App &app, const std::string &version);

} // namespace sparselens
