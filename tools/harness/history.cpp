#include "harness/history.h"

#include "base/text.h"
#include "harness/progress_lines.h"
#include "io/exr/exr_header.h"

#include <CLI/CLI.hpp>
#include <ImfStringAttribute.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

namespace sparselens {

namespace {

// Options that do not affect the picture; those with a value take the next word.
constexpr std::array silent_options{"-o",      "--output", "--depth-out", "--threads", "--max-memory",
                                    "--stats", "--frames", "--progress",  "--device"};
constexpr std::array silent_flags{"-v", "--verbose", "--skip-existing", "--skip-bad-frames"};

// "--threads=4", "-oOUT.exr": option and value in one word.
bool is_silent_with_value(const std::string &word) {
    return (word.starts_with("-o") && word.size() > 2) ||
           (word.starts_with("--") && is_among(silent_options, word.substr(0, word.find('='))));
}

std::string quoted_if_needed(const std::string &word) {
    const auto is_plain = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
               std::string_view("-_=+,./:@%#").find(c) != std::string_view::npos;
    };
    if (!word.empty() && std::ranges::all_of(word, is_plain)) return word;
    return single_quoted(word);
}

} // namespace

std::string command_line(const std::string &tool, const std::vector<std::string> &words) {
    std::string line = tool;
    bool options_ended = false; // after --, all words are names
    for (std::size_t i = 0; i < words.size(); ++i) {
        options_ended = options_ended || words[i] == "--";
        if (options_ended)
            line += " " + quoted_if_needed(one_line(words[i]));
        else if (is_among(silent_options, words[i]))
            ++i; // and its value
        else if (!is_among(silent_flags, words[i]) && !is_silent_with_value(words[i]))
            line += " " + quoted_if_needed(one_line(words[i]));
    }
    return line;
}

void add_history_option(CLI::App &app, HistoryOptions &options) {
    app.add_flag("--no-history", options.none,
                 "Do not record the command line in the metadata (Exif:ImageHistory, Software)")
        ->envname("SPARSELENS_NO_HISTORY");
}

void append_history(Imf::Header &header, const ToolContext &tool, const HistoryOptions &options) {
    if (options.none) return;
    std::string history = text_attribute(header, "Exif:ImageHistory");
    if (!history.empty() && history.back() != '\n') history += '\n';
    set_attribute(header, "Exif:ImageHistory", Imf::StringAttribute(history + tool.command_line));
    set_attribute(header, "Software",
                  Imf::StringAttribute("sparselens " SPARSELENS_VERSION " : " + tool.command_line));
}

} // namespace sparselens
