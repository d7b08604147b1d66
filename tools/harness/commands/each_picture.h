// --stereo-view all and --layer all run the same command once for each stereo view or layer of the input, as --frames
// does for each frame. A placeholder in a name stands for the name of the view (%V, as in Nuke) or of the layer (%L),
// so that every picture has its own output.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace sparselens {

struct EachPicture {
    std::string option, placeholder;
    std::string noun; // "view"
};
const EachPicture &each_view();
const EachPicture &each_layer();

// Whether the words of a command line ask for all views or layers.
bool asks_for_all(const EachPicture &each, const std::vector<std::string> &words);

// Whether word i names an output with this placeholder in its name.
bool is_output_with(const std::string &placeholder, const std::vector<std::string> &words, std::size_t i);

// The words for one view or layer: the option names it, and the placeholder is replaced. Throws UsageError if no output
// has the placeholder in its name.
std::vector<std::string> words_for_one(const EachPicture &each, std::vector<std::string> words,
                                       const std::string &name);

// Whether a command asks for one output for each moment: its output has %s in its name. It is run once for each moment
// of a shutter whose first input exists (io/moment_files.h).
bool asks_for_each_moment(const std::vector<std::string> &words);

// The words for each moment. The moments are those of the first input with %s, at the first frame. If no input has %s,
// or the inputs with %s are files of that very name, %s stands for itself. Throws as moments_on_disk() does.
std::vector<std::vector<std::string>> words_for_moments(const std::vector<std::string> &words);

// Throws UsageError if an input has %s, for tools that make one output of one moment.
void refuse_moments(const std::vector<std::string> &words);

} // namespace sparselens
