#include "harness/frames.h"

#include "base/error.h"
#include "harness/named_files.h"

#include <OpenImageIO/filesystem.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <string_view>
#include <system_error>

namespace sparselens {

namespace {

constexpr std::size_t most_frames = 1'000'000;
constexpr std::size_t longest_name = 4096; // a path's; std::regex goes deeper with every character

// A range of its own (1: "1-24x2"), then # or %04d (2, 3: the digits).
const std::regex &sequence_pattern() {
    static const std::regex pattern(R"((\d{1,7}-\d{1,7}(?:[xy]\d{1,7})?)?(#+|%(0\d{1,2})?d))");
    return pattern;
}

std::string digits(const std::smatch &place, int number) {
    const std::string hashes = place[2];
    int width = 0;
    if (hashes.front() == '#')
        width = hashes.size() == 1 ? 4 : int(std::min<std::size_t>(hashes.size(), 32));
    else if (place[3].matched)
        std::from_chars(&*place[3].first, &*place[3].first + place[3].length(), width);
    return fmt::format("{:0{}}", number, width);
}

// The number between `before` and `after` in a file's name.
std::optional<int> number_in(std::string_view file, std::string_view before, std::string_view after) {
    if (file.size() <= before.size() + after.size() || !file.starts_with(before) || !file.ends_with(after))
        return {};
    file.remove_prefix(before.size());
    file.remove_suffix(after.size());
    int number = 0;
    const auto [end, error] = std::from_chars(file.data(), file.data() + file.size(), number);
    if (error != std::errc() || end != file.data() + file.size()) return {};
    return number;
}

// The numbers of the files that are there, ascending. All but the number is taken as it stands: OpenImageIO takes a
// name for a regular expression, which brackets in it are not, and some of which take forever.
std::vector<int> numbers_on_disk(const std::string &name) {
    namespace fs = std::filesystem;
    std::smatch place;
    std::regex_search(name, place, sequence_pattern());
    const std::string before = place.prefix(), after = place.suffix();
    const std::size_t slash = before.rfind('/') + 1; // 0 where there is none
    const std::string folder = slash > 0 ? before.substr(0, slash) : ".", first = before.substr(slash),
                      last = after.substr(0, after.find('/'));
    std::set<int> numbers;
    std::error_code error, missing; // a folder that is not there has no files
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
        if (const auto number = number_in(entry->path().filename().native(), first, last))
            if (fs::exists(file_at(name, *number), missing)) numbers.insert(*number);
    return {numbers.begin(), numbers.end()};
}

// What a command line gives an option, "" where it does not.
std::string value_of(const std::string &option, const std::vector<std::string> &words) {
    std::string value;
    for (std::size_t i = 0; i < words.size() && words[i] != "--"; ++i) {
        if (words[i].starts_with(option + "=")) value = words[i].substr(option.size() + 1);
        if (words[i] == option && i + 1 < words.size()) value = words[i + 1];
    }
    return value;
}

} // namespace

std::vector<int> frame_numbers(const std::string &range) {
    // first-last, then x and a step, or y and a step whose numbers are left out
    static const std::regex part(R"((-?\d{1,7})(?:-(-?\d{1,7})(?:([xy])(-?\d{1,7}))?)?)");
    const UsageError no_range(
        fmt::format("--frames: invalid frame range '{}' (expected e.g. 1-100x2)", range));
    if (range.size() > longest_name || range.empty()) throw no_range;
    std::vector<int> numbers, more;
    for (std::size_t from = 0, to = 0; to < range.size(); from = to + 1) {
        to = std::min(range.find(',', from), range.size());
        const std::string text = range.substr(from, to - from);
        std::smatch match;
        if (!std::regex_match(text, match, part)) throw no_range;
        const long first = std::stol(match[1]), last = match[2].matched ? std::stol(match[2]) : first,
                   step = match[3] == "x" ? std::max(std::abs(std::stol(match[4])), 1L) : 1;
        if (numbers.size() + std::size_t(std::abs(last - first) / step) >= most_frames) // before making them
            throw UsageError(fmt::format("--frames: '{}' has more than a million frames", range));
        if (!OIIO::Filesystem::enumerate_sequence(text, more)) throw no_range;
        numbers.insert(numbers.end(), more.begin(), more.end());
    }
    if (numbers.empty()) throw no_range;
    return numbers;
}

std::optional<double> keyed_value(const std::string &text, int frame) {
    static const std::regex key(R"((-?\d{1,9}):([-+.0-9a-zA-Z]+)(,|$))");
    std::map<int, double> keys;
    if (text.size() > longest_name) return {};
    auto from = text.begin();
    for (std::smatch m; from != text.end(); from = m[0].second) {
        if (!std::regex_search(from, text.end(), m, key, std::regex_constants::match_continuous)) return {};
        double value = 0;
        const std::string number = m[2];
        const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
        if (error != std::errc() || end != number.data() + number.size()) return {};
        if (!keys.emplace(std::stoi(m[1]), value).second)
            throw UsageError(fmt::format("'{}' gives frame {} twice", text, m[1].str()));
    }
    if (keys.empty() || text.back() == ',') return {};
    const auto after = keys.lower_bound(frame);
    if (after == keys.end()) return keys.rbegin()->second;
    if (after->first == frame || after == keys.begin()) return after->second;
    const auto before = std::prev(after);
    const double t = double(frame - before->first) / double(after->first - before->first);
    return (1 - t) * before->second + t * after->second; // keeps an infinite end infinite
}

std::string file_at(const std::string &name, int number) {
    std::string result;
    auto from = name.begin();
    for (std::smatch place; std::regex_search(from, name.end(), place, sequence_pattern());
         from = place[0].second)
        result += place.prefix().str() + digits(place, number);
    return result.append(from, name.end());
}

FrameCommands::Word FrameCommands::read_word(const std::string &text, const std::string &previous,
                                             bool names_are_names) {
    const bool is_option = text.starts_with("--") && text.find('=') != std::string::npos;
    const std::size_t start = is_option ? text.find('=') + 1 : 0;
    Word word;
    word.before = text.substr(0, start);
    word.value = text.substr(start);
    word.is_output = is_output_word(is_option ? text.substr(0, start - 1) : previous);
    std::smatch place;
    std::error_code error;
    if (word.value.size() > longest_name || (names_are_names && std::filesystem::exists(word.value, error)))
        return word;
    word.is_sequence = std::regex_search(word.value, place, sequence_pattern());
    if (word.is_sequence && place[1].matched) word.own_numbers = frame_numbers(place[1]);
    return word;
}

FrameCommands::FrameCommands(const std::vector<std::string> &words) {
    const std::string range = value_of("--frames", words);
    if (!range.empty()) numbers_ = frame_numbers(range);
    for (std::size_t i = 0; i < words.size(); ++i)
        words_.push_back(read_word(words[i], i > 0 ? words[i - 1] : "", range.empty()));

    const Word *any = nullptr, *input = nullptr;
    for (const Word &word : words_) {
        if (!word.is_sequence) continue;
        if (!any) any = &word;
        if (!input && !word.is_output) input = &word;
        if (numbers_.empty()) numbers_ = word.own_numbers;
    }
    if (numbers_.empty() && input) numbers_ = numbers_on_disk(input->value);
    if (numbers_.empty() && any)
        throw UsageError(any->value + " stands for a sequence of files, but none exists: give --frames");
    for (const Word &word : words_)
        if (!word.own_numbers.empty() && word.own_numbers.size() != numbers_.size())
            throw UsageError(fmt::format("{} has {} frames, not {}", word.value, word.own_numbers.size(),
                                         numbers_.size()));
    for (const Word &word : words_)
        if (word.is_output && !word.is_sequence && size() > 1)
            throw UsageError(
                fmt::format("{} would be written {} times: put #### into its name", word.value, size()));
    if (is_range()) this->words(0); // says what is wrong with keys
}

std::string FrameCommands::word_at(const Word &word, std::size_t i) const {
    if (word.is_sequence)
        return word.before +
               file_at(word.value, word.own_numbers.empty() ? numbers_[i] : word.own_numbers[i]);
    const auto value = keyed_value(word.value, numbers_[i]);
    if (!value) return word.before + word.value;
    return word.before + fmt::to_string(*value);
}

std::vector<std::string> FrameCommands::words(std::size_t i) const {
    std::vector<std::string> result;
    for (const Word &word : words_)
        result.push_back(is_range() ? word_at(word, i) : word.before + word.value);
    return result;
}

} // namespace sparselens
