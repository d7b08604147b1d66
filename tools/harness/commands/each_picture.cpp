#include "harness/commands/each_picture.h"

#include "base/error.h"
#include "harness/commands/named_files.h"

#include <algorithm>

namespace sparselens {

namespace {

const std::string option = "--stereo-view", placeholder = "%V";

// The index of the word that holds the value of the option; the number of words if there is none.
std::size_t value_of_option(const std::vector<std::string> &words) {
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (words[i] == option) return i + 1;
        if (words[i].starts_with(option + "=")) return i;
    }
    return words.size();
}

bool is_output_with_place(const std::vector<std::string> &words, std::size_t i) {
    if (words[i].find(placeholder) == std::string::npos) return false;
    const std::string joined = words[i].substr(0, words[i].find('='));
    return (i > 0 && is_output_word(words[i - 1])) || is_output_word(joined) || joined.starts_with("-o");
}

} // namespace

bool asks_for_all_views(const std::vector<std::string> &words) {
    const std::size_t i = value_of_option(words);
    return i < words.size() && (words[i] == "all" || words[i] == option + "=all");
}

std::vector<std::string> words_for_view(std::vector<std::string> words, const std::string &view) {
    bool named = false;
    for (std::size_t i = 0; i < words.size(); ++i) named = named || is_output_with_place(words, i);
    if (!named)
        throw UsageError(
            "--stereo-view all writes one file per view: put %V, which stands for the name of the view, "
            "into the name of the output, e.g. -o out.%V.exr");
    const std::size_t value = value_of_option(words);
    words[value] = words[value].starts_with(option) ? option + "=" + view : view;
    for (std::string &word : words)
        for (std::size_t at = word.find(placeholder); at != std::string::npos;
             at = word.find(placeholder, at + view.size()))
            word.replace(at, placeholder.size(), view);
    return words;
}

} // namespace sparselens
