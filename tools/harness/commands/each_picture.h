// --stereo-view all: the same command once for each stereo view of the input, as --frames is for each frame. %V in a
// name stands for the name of the view (as in Nuke), so that every view has an output of its own.
#pragma once

#include <string>
#include <vector>

namespace sparselens {

// Whether the words of a command line ask for all views.
bool asks_for_all_views(const std::vector<std::string> &words);

// The words for one view: --stereo-view names it, and %V is replaced. Throws UsageError if no output has %V in its name.
std::vector<std::string> words_for_view(std::vector<std::string> words, const std::string &view);

} // namespace sparselens
