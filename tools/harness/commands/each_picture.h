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

} // namespace sparselens
