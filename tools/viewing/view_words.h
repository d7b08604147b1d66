// The picture that a page shows, as the words of a command line of dof-gather: those that the server was started with, and
// what the page has set. So a page can set nothing that a command line cannot say, and what is shown has a command.
#pragma once

#include "options/gather_options.h"

#include <map>
#include <string>
#include <vector>

namespace sparselens {

using Words = std::vector<std::string>;

// Lenses that the page offers by name: the files of share/lenses by their names (petzval), where the program was installed or
// built; empty where there are none.
using Presets = std::map<std::string, std::string>;
Presets lens_presets();

// The words of a command line of dof-view that dof-gather has too: IN, and how its picture is made.
Words picture_words(const Words &all);

// The words with the settings of a page over them (Asked::settings); its lens is the name of a preset. Throws UsageError where
// a page may not set that option.
Words words_with(const Words &given, const std::map<std::string, std::string> &settings,
                 const Presets &presets = {});

// What the words ask for. Throws UsageError as a command line is refused.
GatherCommand command_of(const Words &words);

// The words without those that do not apply to such an output: an EXR file has no display.
Words words_for(const Words &words, const std::string &output);

// The command that makes the picture, for a shell, and as a script for Python.
std::string shell_command(const Words &words, const std::string &output);
std::string python_script(const Words &words, const std::string &input, const std::string &output);

} // namespace sparselens
