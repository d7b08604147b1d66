// A command whose output has %s in its name is run once for each moment of a shutter whose first input exists
// (io/moment_files.h), as --stereo-view all runs it for each eye.
#pragma once

#include <string>
#include <vector>

namespace sparselens {

// Whether a command asks for one output for each moment.
bool asks_for_each_moment(const std::vector<std::string> &words);

// The words for each moment. The moments are those of the first input with %s, at the first frame. If no input has %s,
// or the inputs with %s are files of that very name, %s stands for itself. Throws as moments_on_disk() does.
std::vector<std::vector<std::string>> words_for_moments(const std::vector<std::string> &words);

// Throws UsageError if an input has %s, for tools that make one output of one moment.
void refuse_moments(const std::vector<std::string> &words);

} // namespace sparselens
