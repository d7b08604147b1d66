// Small helpers for text. They work on bytes and ignore the locale: only the letters of ASCII have a case.
#pragma once

#include <algorithm>
#include <charconv>
#include <functional>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace sparselens {

std::string lower_case(std::string text);
std::string upper_case(std::string text);

// The text in single quotes, as a POSIX shell reads it: it's becomes 'it'\''s'.
std::string single_quoted(std::string_view text);

// The words of a list such as "R,G,B".
std::vector<std::string> words_between_commas(const std::string &list);

// Guesses which of `words` was meant by `given`, which is none of them: the word with the fewest letters and digits to
// add, leave out or exchange. Case and all other characters are ignored (--f-stop is --fstop). Empty if more than a
// third of the letters and digits would change, or if there are none.
std::string nearest_word(std::string_view given, std::span<const std::string> words);

// Replaces each parameter in a message (see error.h) by what `spelling` returns for its name and its value, which may
// be empty.
using Spelling = std::function<std::string(const std::string &name, const std::string &value)>;
std::string spelled(std::string_view message, const Spelling &spelling);

// The text without the blanks around it.
std::string_view trimmed(std::string_view text, std::string_view blanks = " \t\r\n");

// The number that the text is; nothing if there is anything else in it.
template <typename Number>
std::optional<Number> number_of(std::string_view text) {
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

// Whether `word` is one of `words`, a range of strings.
bool is_among(const auto &words, std::string_view word) {
    return std::ranges::find(words, word) != std::ranges::end(words);
}

} // namespace sparselens
