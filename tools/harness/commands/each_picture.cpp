#include "harness/commands/each_picture.h"

#include "base/error.h"
#include "harness/commands/file_arguments.h"
#include "harness/commands/frames.h"
#include "io/moment_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace sparselens {

namespace {

// The index of the word that holds the option's value; the number of words if there is none.
std::size_t value_of_option(const std::string &option, const std::vector<std::string> &words) {
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (words[i] == option) return i + 1;
        if (words[i].starts_with(option + "=")) return i;
    }
    return words.size();
}

// The word with the text in the place of each placeholder in its value.
std::string filled(const std::string &word, const std::string &placeholder, const std::string &text) {
    const std::size_t start = start_of_value(word);
    return word.substr(0, start) + with_placeholder(word.substr(start), placeholder, text);
}

bool has_placeholder(const std::string &word, const std::string &placeholder) {
    return filled(word, placeholder, "") != word;
}

} // namespace

bool is_output_with(const std::string &placeholder, const std::vector<std::string> &words, std::size_t i) {
    if (!has_placeholder(words[i], placeholder)) return false;
    const std::string joined = words[i].substr(0, words[i].find('='));
    return (i > 0 && is_output_word(words[i - 1])) || is_output_word(joined) || joined.starts_with("-o");
}

const EachPicture &each_view() {
    static const EachPicture each{"--stereo-view", "%V", "view"};
    return each;
}

const EachPicture &each_layer() {
    static const EachPicture each{"--layer", "%L", "layer"};
    return each;
}

bool asks_for_all(const EachPicture &each, const std::vector<std::string> &words) {
    const std::size_t i = value_of_option(each.option, words);
    return i < words.size() && (words[i] == "all" || words[i] == each.option + "=all");
}

std::vector<std::string> words_for_one(const EachPicture &each, std::vector<std::string> words,
                                       const std::string &name) {
    bool named = false;
    for (std::size_t i = 0; i < words.size(); ++i)
        named = named || is_output_with(each.placeholder, words, i);
    if (!named)
        throw UsageError(fmt::format("{0} all writes one file per {1}: put {2}, which stands for the name of "
                                     "the {1}, into the name of the output, e.g. -o out.{2}.exr",
                                     each.option, each.noun, each.placeholder));
    const std::size_t value = value_of_option(each.option, words);
    words[value] = words[value].starts_with(each.option) ? each.option + "=" + name : name;
    for (std::string &word : words) word = filled(word, each.placeholder, name);
    return words;
}

namespace {

// The first input with %s at the first frame, or nothing.
std::optional<std::string> input_of_moments(const std::vector<std::string> &words) {
    if (std::ranges::none_of(words, [](auto &word) { return has_placeholder(word, moment_placeholder); }))
        return {};
    const std::vector<std::string> first = FrameCommands(words).words(0);
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (is_output_with(moment_placeholder, words, i)) continue;
        const std::string name = first[i].substr(start_of_value(first[i]));
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
        for (std::string &word : commands.back()) word = filled(word, moment_placeholder, number);
    }
    return commands;
}

void refuse_moments(const std::vector<std::string> &words) {
    if (const std::optional<std::string> input = input_of_moments(words))
        throw UsageError(*input +
                         ": %s stands for the number of a moment: put it into the name of the output, too");
}

} // namespace sparselens
