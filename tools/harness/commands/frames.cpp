#include "harness/commands/frames.h"

#include "base/error.h"
#include "base/system/system.h"
#include "base/text.h"
#include "chain/parameters.h"
#include "harness/commands/file_arguments.h"
#include "io/moment_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <regex>
#include <set>
#include <string_view>
#include <system_error>

namespace sparselens {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_frames = 1'000'000;
constexpr std::size_t longest_name = 4096; // of a path; std::regex recurses once per character

// The position of a number in a name: the characters from `begin` to `end`, including a range before the number, if
// any.
struct Place {
    std::size_t begin = 0, end = 0;
    std::string range;  // "1-24x2"
    int width = 0;      // digits, with zeros before the number
    bool joins = false; // a letter or a digit, so that a minus between is a hyphen
};

// An optional range (1: at least one part is more than a number), then #, @@, %04d (2, 3: the digits) or $F4 (4: the
// digit). A single @ is an ordinary character of a name, as in shot@2x.exr.
const std::regex &sequence_pattern() {
    static const std::string number = R"(-?\d{1,7})", span = number + "-" + number + R"((?:[xy:]-?\d{1,7})?)",
                             part = "(?:" + span + "|" + number + ")";
    static const std::regex pattern("(" + span + "(?:," + part + ")*|" + number + "(?:," + part +
                                    R"()+)?(#+|@@+|%(0\d{1,2})?d|\$F([1-9]?)(?![A-Za-z0-9_])))");
    return pattern;
}

int width_of(const std::smatch &match) {
    const std::string sign = match[2];
    if (sign == "#") return 4;
    if (sign.front() == '#' || sign.front() == '@') return int(std::min<std::size_t>(sign.size(), 32));
    const std::string digits = sign.front() == '$' ? match[4] : match[3];
    return number_of<int>(digits).value_or(0);
}

std::optional<Place> find_place(const std::string &name, std::size_t from) {
    std::smatch match;
    if (!std::regex_search(name.begin() + std::ptrdiff_t(from), name.end(), match, sequence_pattern()))
        return {};
    const std::size_t begin = from + std::size_t(match.position());
    Place place{begin, begin + std::size_t(match.length()), match[1], width_of(match),
                begin > 0 && std::isalnum(static_cast<unsigned char>(name[begin - 1]))};
    if (place.joins && place.range.starts_with('-')) {
        ++place.begin;
        place.range.erase(0, 1);
    }
    return place;
}

// The name with the text that `text_for` gives for a place in each place behind the folders that exist.
template <typename TextFor>
std::string filled(const std::string &name, const TextFor &text_for) {
    std::size_t from = existing_folders(name);
    std::string result = name.substr(0, from);
    for (auto place = find_place(name, from); place; from = place->end, place = find_place(name, from))
        result += name.substr(from, place->begin - from) + text_for(*place);
    return result + name.substr(from);
}

std::string with_sign(const std::string &name, const std::string &sign) {
    return filled(name, [&sign](const Place &) { return sign; });
}

// Whether the file exists, or files of moments do.
bool is_there(const std::string &name) try {
    std::error_code error;
    return names_moments(name) ? !moments_on_disk(name).empty() : fs::exists(name, error);
} catch (const Error &) { // there are no moments
    return false;
}

// The file of the frame as it is read: of a negative frame, -003 or, if only that is there, -0003.
std::string file_read_at(const std::string &name, int number) {
    const std::string file = file_at(name, number);
    if (number >= 0 || is_there(file)) return file;
    const std::string wider = filled(name, [number](const Place &place) {
        return fmt::format("{:0{}}", number, place.width + (place.joins ? 0 : 1));
    });
    return is_there(wider) ? wider : file;
}

// The number between `before` and `after` in a file's name.
std::optional<int> number_in(std::string_view file, std::string_view before, std::string_view after) {
    if (file.size() <= before.size() + after.size() || !file.starts_with(before) || !file.ends_with(after))
        return {};
    file.remove_prefix(before.size());
    file.remove_suffix(after.size());
    return number_of<int>(file);
}

struct OnDisk {
    std::set<int> numbers; // of the files
    std::set<std::pair<int, std::string>>
        left_out; // numbers with other digits, and the sign (%d) that takes them
};

OnDisk found_on_disk(const std::string &name);

// The numbers of the frames of which a file for the first moment of the shutter exists: moment 0 or 1.
OnDisk frames_of_first_moment(const std::string &name) {
    OnDisk found;
    for (const int width : {1, 2, 3, 4})
        for (const int first : {0, 1}) {
            OnDisk here = found_on_disk(at_moment(name, fmt::format("{:0{}}", first, width)));
            if (!here.numbers.empty()) return here;
            found.left_out.merge(here.left_out);
        }
    return found;
}

// Everything but the number is compared literally: OpenImageIO would treat the name as a regular expression, which
// fails for brackets, and some expressions take forever.
OnDisk found_on_disk(const std::string &name) {
    const auto place = find_place(name, existing_folders(name));
    if (!place) return {};
    if (names_moments(name)) return frames_of_first_moment(name);
    const std::string before = name.substr(0, place->begin), after = name.substr(place->end);
    const std::size_t slash = before.find_last_of(system::separators) + 1; // 0 if there is none
    const std::string folder = slash > 0 ? before.substr(0, slash) : ".", first = before.substr(slash),
                      last = after.substr(0, after.find_first_of(system::separators));
    OnDisk found;
    std::error_code error; // a folder that is not there has no files
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
        const std::string file = entry->path().filename().string();
        const auto number = number_in(file, first, last);
        if (!number) continue;
        const std::size_t digits = file.size() - first.size() - last.size();
        const bool has_zeros = digits > fmt::to_string(*number).size();
        const std::string sign = has_zeros ? fmt::format("%0{}d", digits) : "%d";
        if (is_there(file_read_at(name, *number)))
            found.numbers.insert(*number);
        else if (is_there(file_at(with_sign(name, sign), *number)))
            found.left_out.emplace(*number, sign);
    }
    return found;
}

// The parameter of an option whose values can be keyed by frame, in a word or in a file (@keys.txt); else null.
const Parameter *keyed_parameter(const std::string &option) {
    const Parameter *found = option.starts_with("--") ? find_parameter(option.substr(2)) : nullptr;
    return found && found->keyable ? found : nullptr;
}

} // namespace

std::string value_of(const std::string &option, const std::vector<std::string> &words) {
    std::string value;
    for (std::size_t i = 0; i < words.size() && words[i] != "--"; ++i) {
        if (words[i].starts_with(option + "=")) value = words[i].substr(option.size() + 1);
        if (words[i] == option && i + 1 < words.size()) value = words[i + 1];
    }
    return value;
}

std::vector<int> frame_numbers(const std::string &range) {
    // first-last, then x or : and a step, or y and a step whose numbers are left out
    static const std::regex part(
        R"([ \t]*(-?\d{1,7})(?:[ \t]*-[ \t]*(-?\d{1,7})(?:([xy:])(-?\d{1,7}))?)?[ \t]*)");
    const UsageError no_range(
        fmt::format("--frames: invalid frame range '{}' (expected e.g. 1-100, 1-100x2 or 1,3,5-9)", range));
    if (range.size() > longest_name || range.empty()) throw no_range;
    std::vector<int> numbers;
    for (std::size_t from = 0, to = 0; to < range.size(); from = to + 1) {
        to = std::min(range.find(',', from), range.size());
        const std::string text = range.substr(from, to - from);
        std::smatch match;
        if (!std::regex_match(text, match, part)) throw no_range;
        int first = std::stoi(match[1]), last = match[2].matched ? std::stoi(match[2]) : first,
            step = match[4].matched ? std::stoi(match[4]) : 1;
        if (step == 0) step = 1;
        const bool left_out = match[3] == "y";
        if (numbers.size() + std::size_t(std::abs((last - first) / (left_out ? 1 : step))) >= most_frames)
            throw UsageError(fmt::format("--frames: '{}' has more than a million frames", range));
        if (step < 0 && first < last) std::swap(first, last); // a step below 0 counts down
        for (int number = first, way = last < first ? -1 : 1; number != last + way; number += way)
            if (((number - first) % step == 0) != left_out) numbers.push_back(number);
    }
    if (numbers.empty()) throw no_range;
    return numbers;
}

std::string file_at(const std::string &name, int number) {
    return filled(name, [number](const Place &place) { return fmt::format("{:0{}}", number, place.width); });
}

FrameCommands::Word FrameCommands::read_word(const std::string &text, const std::string &previous,
                                             const std::vector<int> &numbers) {
    const std::size_t start = start_of_value(text);
    const std::string option = start > 0 ? text.substr(0, std::min(start, text.find('='))) : previous;
    Word word;
    word.before = text.substr(0, start);
    word.value = text.substr(start);
    word.is_output = is_output_word(option);
    const Parameter *keyed = keyed_parameter(option);
    const KeyKind kind = keyed && keyed->form == ParameterForm::pixel  ? KeyKind::pixel
                         : keyed && keyed->form == ParameterForm::pair ? KeyKind::pair
                                                                       : KeyKind::number;
    word.keys_from_file = keyed && word.value.starts_with('@');
    if (word.keys_from_file)
        word.keys = read_keys(word.value.substr(1), kind, option);
    else if (option.starts_with('-'))
        word.keys = parse_keys(word.value, kind);
    if (word.keys && keyed) word.keyed_option = option;
    if (word.keys || word.value.size() > longest_name) return word;
    std::error_code error;
    word.is_name = fs::exists(word.value, error);
    if (word.is_name && !word.is_output &&
        (numbers.empty() || !is_there(file_read_at(word.value, numbers.front()))))
        return word;
    const auto place = find_place(word.value, existing_folders(word.value));
    word.is_sequence = place.has_value();
    if (place && !place->range.empty()) word.own_numbers = frame_numbers(place->range);
    return word;
}

FrameCommands::FrameCommands(const std::vector<std::string> &words) {
    const std::string range = value_of("--frames", words);
    if (!range.empty()) numbers_ = frame_numbers(range);
    bool options_ended = false; // after --, all words are names
    for (std::size_t i = 0; i < words.size(); ++i) {
        words_.push_back(read_word(words[i], i > 0 && !options_ended ? words[i - 1] : "", numbers_));
        options_ended = options_ended || words[i] == "--";
    }

    const auto reads_frames = [](const Word &word) { return word.is_sequence && !word.is_output; };
    if (range.empty() && std::ranges::none_of(words_, reads_frames))
        for (Word &word : words_)
            if (word.is_name) word.is_sequence = false;
    const Word *any = nullptr, *input = nullptr;
    for (const Word &word : words_) {
        if (!word.is_sequence) continue;
        if (!any) any = &word;
        if (!input && !word.is_output) input = &word;
        if (numbers_.empty()) numbers_ = word.own_numbers;
    }
    if (numbers_.empty() && input) {
        const OnDisk found = found_on_disk(input->value);
        numbers_.assign(found.numbers.begin(), found.numbers.end());
        if (!found.left_out.empty()) {
            const auto &[number, sign] = *found.left_out.begin();
            const std::string other = with_sign(input->value, sign);
            warnings_.push_back(
                fmt::format("{} leaves out {} of {} files by their number of digits: {} takes {}",
                            input->value, found.left_out.size(), found.left_out.size() + numbers_.size(),
                            other, file_at(other, number)));
            if (numbers_.empty()) throw UsageError(warnings_.back());
        }
    }
    if (numbers_.empty() && any)
        throw UsageError(any->value + " stands for a sequence of files, but none exists: give --frames");
    for (const Word &word : words_)
        if (word.is_sequence && !word.own_numbers.empty() && word.own_numbers.size() != numbers_.size())
            throw UsageError(fmt::format("{} has {} frames, not {}", word.value, word.own_numbers.size(),
                                         numbers_.size()));
    for (const Word &word : words_)
        if (word.is_output && !word.is_sequence && !holds_all_frames(word.value) && size() > 1)
            throw UsageError(
                fmt::format("{} would be written {} times: put #### into its name", word.value, size()));
    for (const Word &word : words_)
        if (word.keys_from_file && !is_range())
            throw UsageError(word.value + " holds a value for each frame: give --frames");
    for (const Word &word : words_) {
        if (word.keyed_option.empty()) continue;
        if (!is_range())
            throw UsageError(fmt::format("{} {} is keyed by frame, and keys need --frames", word.keyed_option,
                                         word.value));
        warn_of_keys(word);
    }
}

void FrameCommands::warn_of_keys(const Word &word) {
    const auto [first, last] = std::ranges::minmax(numbers_);
    const int from = word.keys->by_frame.begin()->first, to = word.keys->by_frame.rbegin()->first;
    if (first <= to && last >= from) return;
    warnings_.push_back(fmt::format("{} is {} for all frames: they are {} to {}, and its keys {} to {}",
                                    word.keyed_option, word_at_frame(*word.keys, first), first, last, from,
                                    to));
}

std::string FrameCommands::other_frame(std::size_t i, const std::string &name, int later) const {
    for (const Word &word : words_)
        if (word.is_sequence && is_range() && name_at(word, i) == name) return name_at(word, i, later);
    return name;
}

std::string FrameCommands::name_at(const Word &word, std::size_t i, int later) const {
    const int number = (word.own_numbers.empty() ? numbers_[i] : word.own_numbers[i]) + later;
    return word.is_output ? file_at(word.value, number) : file_read_at(word.value, number);
}

std::string FrameCommands::word_at(const Word &word, std::size_t i) const {
    if (word.is_sequence) return word.before + name_at(word, i);
    return word.before + (word.keys ? word_at_frame(*word.keys, numbers_[i]) : word.value);
}

std::vector<std::string> FrameCommands::words(std::size_t i) const {
    std::vector<std::string> result;
    for (const Word &word : words_)
        result.push_back(is_range() ? word_at(word, i) : word.before + word.value);
    return result;
}

} // namespace sparselens
