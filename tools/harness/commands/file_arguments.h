// Lists the files that a command line reads and writes: the one table of the options whose values are files.
#pragma once

#include "harness/commands/cli.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sparselens {

// Whether the word is an option whose value is an output: -o, --output, --depth-out, --cameras.
bool is_output_word(std::string_view word);

// Whether one such output holds what all frames of a range give: the cameras of ldi-plan as USD, keyed.
bool holds_all_frames(std::string_view path);

// Whether the word is an option whose value is a file that is read: --lens, --depth-file, ...
bool is_input_word(std::string_view word);

// Where the value begins in a word that also holds its option, --output=x.exr or -ox.exr; 0 for other words.
std::size_t start_of_value(std::string_view word);

struct NamedFile {
    std::string option, path;
};

struct NamedFiles {
    std::vector<NamedFile> outputs, inputs;
    std::vector<NamedFile> also_written; // besides the outputs: --stats, and the files of --masks that exist
};

NamedFiles named_files(const CLI::App &parsed);

// Checks the frames of a range, or one command. Throws UsageError if an output is a file that any of them reads, or if
// two options write one file. Names are compared after symbolic and hard links are followed; folders and devices are
// not compared.
void refuse_overwriting(std::span<const NamedFiles> commands);

} // namespace sparselens
