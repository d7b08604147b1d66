#include "harness/commands/each_moment.h"

#include "base/error.h"
#include "harness/commands/each_picture.h"
#include "harness/commands/frames.h"
#include "io/moment_files.h"

#include <algorithm>
#include <cstddef>
#include <optional>

namespace sparselens {

namespace {

bool has_placeholder(const std::string &word) { return word.find(moment_placeholder) != std::string::npos; }

// The first input with %s at the first frame, or nothing.
std::optional<std::string> input_of_moments(const std::vector<std::string> &words) {
    if (std::ranges::none_of(words, has_placeholder)) return {};
    const std::vector<std::string> first = FrameCommands(words).words(0);
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (is_output_with(moment_placeholder, words, i)) continue;
        const bool is_option = first[i].starts_with("--") && first[i].find('=') != std::string::npos;
        const std::string name = is_option ? first[i].substr(first[i].find('=') + 1) : first[i];
        if (names_moments(name)) return name;
    }
    return {};
}

} // namespace

bool asks_for_each_moment(const std::vector<std::string> &words) {
    for (std::size_t i = 0; i < words.size(); ++i)
        if (is_output_with(moment_placeholder, words, i)) return true;
    return false;
}

std::vector<std::vector<std::string>> words_for_moments(const std::vector<std::string> &words) {
    const std::optional<std::string> input = input_of_moments(words);
    if (!input) return {words};
    std::vector<std::vector<std::string>> commands;
    for (const std::string &number : moments_on_disk(*input)) {
        commands.push_back(words);
        for (std::string &word : commands.back()) word = at_moment(word, number);
    }
    return commands;
}

void refuse_moments(const std::vector<std::string> &words) {
    if (const std::optional<std::string> input = input_of_moments(words))
        throw UsageError(*input +
                         ": %s stands for the number of a moment: put it into the name of the output, too");
}

} // namespace sparselens
