#include "base/text.h"

#include <numeric>
#include <sstream>
#include <utility>

namespace sparselens {

namespace {

std::string letters_and_digits(std::string_view text) {
    std::string result = lower_case(std::string(text));
    std::erase_if(result, [](char c) { return (c < 'a' || c > 'z') && (c < '0' || c > '9'); });
    return result;
}

// Levenshtein's distance, by rows of its table.
std::size_t edits_between(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), 0);
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = std::exchange(row[0], i + 1);
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t exchanged = diagonal + (a[i] != b[j]);
            diagonal = row[j + 1];
            row[j + 1] = std::min({exchanged, row[j] + 1, diagonal + 1});
        }
    }
    return row.back();
}

} // namespace

std::vector<std::string> words_between_commas(const std::string &list) {
    std::vector<std::string> words;
    std::istringstream in(list);
    for (std::string word; std::getline(in, word, ',');) words.push_back(word);
    return words;
}

std::string nearest_word(std::string_view given, std::span<const std::string> words) {
    constexpr std::size_t longest = 100; // no word is longer, and the time is that squared
    const std::string meant = letters_and_digits(given.substr(0, longest));
    std::string nearest;
    std::size_t fewest = meant.size() / 3 + 1;
    for (const std::string &word : words) {
        const std::size_t edits = edits_between(meant, letters_and_digits(word));
        if (meant.empty() || edits >= fewest) continue;
        fewest = edits;
        nearest = word;
    }
    return nearest;
}

std::string spelled(std::string_view message, const Spelling &spelling) {
    std::string text;
    for (std::size_t begin = message.find('`'); begin != message.npos; begin = message.find('`')) {
        const std::string_view rest = message.substr(begin + 1), inside = rest.substr(0, rest.find('`')),
                               name = inside.substr(0, inside.find('='));
        const bool is_parameter = inside.size() < rest.size() && !name.empty() &&
                                  name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_") == name.npos;
        text += message.substr(0, begin);
        text += is_parameter ? spelling(std::string(name),
                                        std::string(inside.substr(std::min(name.size() + 1, inside.size()))))
                             : "`";
        message = rest.substr(is_parameter ? inside.size() + 1 : 0);
    }
    return text += message;
}

std::string lower_case(std::string text) {
    for (char &c : text)
        if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
    return text;
}

std::string upper_case(std::string text) {
    for (char &c : text)
        if (c >= 'a' && c <= 'z') c = char(c - 'a' + 'A');
    return text;
}

std::string_view trimmed(std::string_view text, std::string_view blanks) {
    const std::size_t first = text.find_first_not_of(blanks);
    if (first == text.npos) return {};
    return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::string single_quoted(std::string_view text) {
    std::string result = "'";
    for (const char c : text) {
        if (c == '\'')
            result += "'\\''";
        else
            result += c;
    }
    return result + "'";
}

} // namespace sparselens
