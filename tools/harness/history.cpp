#include "harness/history.h"

#include "base/error.h"
#include "base/text.h"
#include "harness/progress_lines.h"
#include "io/exr/exr_header.h"
#include "io/files/file_stream.h"

#include <CLI/CLI.hpp>
#include <ImfCheckFile.h>
#include <ImfMultiPartInputFile.h>
#include <ImfStringAttribute.h>
#include <ImfTestFile.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <optional>
#include <string_view>

namespace sparselens {

namespace {

// Options that do not affect the picture; those with a value take the next word.
constexpr std::array silent_options{"-o",      "--output", "--depth-out", "--threads", "--max-memory",
                                    "--stats", "--frames", "--progress",  "--device"};
constexpr std::array silent_flags{"-v", "--verbose", "-u", "--update", "--skip-bad-frames"};

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

std::string text_of(const Imf::Header &header, const char *name) {
    const auto *text = header.findTypedAttribute<Imf::StringAttribute>(name);
    return text ? text->value() : std::string();
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
                 "Do not record the command line in the metadata, in Exif:ImageHistory and Software")
        ->envname("SPARSELENS_NO_HISTORY");
}

bool records_history(const CLI::App &parsed) {
    const CLI::Option *none = parsed.get_option_no_throw("--no-history");
    return none && none->count() == 0;
}

std::optional<std::string> last_command(const std::string &path) {
    if (!Imf::isOpenExrFile(path.c_str())) return {};
    const auto stream = open_input(path);
    check_header(*stream, path);
    const Imf::MultiPartInputFile file(*stream);
    const std::string history = text_of(file.header(0), "Exif:ImageHistory");
    if (history.empty()) return {};
    return history.substr(history.rfind('\n') + 1);
}

void append_history(Imf::Header &header, const ToolContext &tool, const HistoryOptions &options) {
    if (options.none) return;
    std::string history = text_of(header, "Exif:ImageHistory");
    if (!history.empty() && history.back() != '\n') history += '\n';
    set_attribute(header, "Exif:ImageHistory", Imf::StringAttribute(history + tool.command_line));
    set_attribute(header, "Software",
                  Imf::StringAttribute("sparselens " SPARSELENS_VERSION " : " + tool.command_line));
}

namespace {

namespace fs = std::filesystem;

// Checks that an output is complete. Tools write a file whole or not at all, but a full disk or an interrupted copy may
// have cut it short.
bool is_complete(const fs::path &file) {
    std::error_code error;
    if (!fs::is_regular_file(file, error) || fs::file_size(file, error) == 0) return false;
    if (file.extension() != ".exr") return true;
    try {
        check_header(*open_input(file.string()),
                     file.string()); // before OpenEXR relies on the header
        return !Imf::checkOpenEXRFile(file.c_str());
    } catch (const Error &) {
        return false;
    }
}

bool is_newest(const std::string &output, const std::vector<NamedFile> &inputs) {
    std::error_code error;
    const auto time = [&](const std::string &file) { return fs::last_write_time(file, error); };
    return std::ranges::all_of(inputs, [&](const NamedFile &input) {
        return !fs::is_regular_file(input.path, error) || time(input.path) <= time(output);
    });
}

// An output without its own history has the history of its input, whose last command belongs to another tool. An output
// that cannot be read is made again.
Freshness compare_command(const std::string &output, const std::string &command_line) try {
    const std::optional<std::string> last = last_command(output);
    const std::string tool = command_line.substr(0, command_line.find(' ')) + ' ';
    if (command_line.empty() || !last || !last->starts_with(tool)) return Freshness::not_compared;
    return *last == command_line ? Freshness::fresh : Freshness::stale;
} catch (const std::exception &) {
    return Freshness::stale;
}

} // namespace

Freshness freshness_of(const NamedFiles &files, const std::string &command_line) {
    if (files.outputs.empty()) return Freshness::stale;
    Freshness all = Freshness::fresh;
    for (const NamedFile &output : files.outputs) {
        if (!is_complete(output.path) || !is_newest(output.path, files.inputs)) return Freshness::stale;
        const Freshness own = compare_command(output.path, command_line);
        if (own == Freshness::stale) return own;
        if (own == Freshness::not_compared) all = own;
    }
    return all;
}

} // namespace sparselens
