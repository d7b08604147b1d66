#include "harness/commands/file_arguments.h"

#include "base/error.h"
#include "base/system/system.h"
#include "base/text.h"
#include "io/moment_files.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <map>
#include <utility>

namespace sparselens {

namespace {

namespace fs = std::filesystem;

constexpr std::array output_options{"--output", "--depth-out", "--cameras", "--ask"};
constexpr std::array input_options{
    "--view", "--camera", "--depth-file", "--center",   "--holdout",  "--colorconfig", "--regions",
    "--plan", "--lens",   "--aperture",   "--denoised", "--gathered", "--recolor",     "--shutter-curve"};

bool is_input(const CLI::Option &option) {
    return option.get_positional() || is_among(input_options, option.get_name());
}

// The files that a name stands for: those of a shutter's moments, or itself.
std::vector<std::string> files_of_moments(const std::string &name) try {
    if (!names_moments(name)) return {name};
    std::vector<std::string> files;
    for (const std::string &number : moments_on_disk(name)) files.push_back(at_moment(name, number));
    return files;
} catch (const Error &) { // there are none yet
    return {name};
}

void add(std::vector<NamedFile> &files, const CLI::Option &option) {
    const std::size_t step = option.get_name() == "--view" ? 2 : 1; // X,Y and the file
    const std::vector<std::string> &words = option.results();
    for (std::size_t i = step - 1; i < words.size(); i += step)
        for (std::string &file : files_of_moments(words[i]))
            files.push_back({option.get_name(), std::move(file)});
}

// ldi-plan writes view_0.exr, view_1.exr, ... into the folder.
void add_masks(std::vector<NamedFile> &files, const CLI::Option &option) {
    constexpr int most_views = 64;
    std::error_code error;
    for (const std::string &folder : option.results())
        for (int k = 0; k < most_views; ++k) {
            const fs::path mask = fs::path(folder) / fmt::format("view_{}.exr", k);
            if (fs::exists(mask, error)) files.push_back({option.get_name(), mask.string()});
        }
}

// Equal for two names of one file; empty for a folder or a device.
std::string identity(const std::string &path) {
    if (path == "-") return path;
    if (const auto stamp = system::stamp_of(path)) return stamp->identity;
    std::error_code error; // the file does not exist yet: find where it would be written
    fs::path target = path;
    for (int links = 0; links < 40 && fs::is_symlink(target, error); ++links)
        target = target.parent_path() / fs::read_symlink(target, error);
    return fs::weakly_canonical(fs::absolute(target, error), error).string();
}

using Readers = std::map<std::string, std::string>; // identity of a file that is read -> its name

// Files that do not exist are left out: one frame may write them and the next read them.
Readers readers_of(std::span<const NamedFiles> commands) {
    Readers readers;
    std::error_code error;
    for (const NamedFiles &files : commands)
        for (const NamedFile &input : files.inputs)
            if (input.path != "-" && (commands.size() > 1 || fs::exists(input.path, error)))
                readers.emplace(identity(input.path), input.path);
    readers.erase("");
    return readers;
}

} // namespace

bool holds_all_frames(std::string_view path) {
    return path.ends_with(".usda") || path.ends_with(".usdc") || path.ends_with(".usd");
}

bool is_input_word(std::string_view word) { return is_among(input_options, word); }

bool is_output_word(std::string_view word) { return word == "-o" || is_among(output_options, word); }

std::size_t start_of_value(std::string_view word) {
    if (word.starts_with("--")) return word.find('=') + 1; // 0 if there is none
    return word.starts_with("-o") && word.size() > 2 ? 2 : 0;
}

NamedFiles named_files(const CLI::App &parsed) {
    NamedFiles files;
    for (const CLI::Option *option : parsed.get_options()) {
        if (is_among(output_options, option->get_name())) add(files.outputs, *option);
        if (option->get_name() == "--stats" && option->count() > 0 &&
            option->results().front() != "-") // - is stderr
            add(files.also_written, *option);
        if (option->get_name() == "--masks") add_masks(files.also_written, *option);
        if (is_input(*option)) add(files.inputs, *option);
    }
    return files;
}

void refuse_overwriting(std::span<const NamedFiles> commands) {
    const Readers readers = readers_of(commands);
    std::map<std::string, std::string> writers; // identity of a file that is written -> the option
    for (const NamedFiles &files : commands)
        for (const auto *written : {&files.outputs, &files.also_written})
            for (const auto &[option, path] : *written) {
                const std::string file = identity(path);
                if (file.empty()) continue;
                if (const auto reader = readers.find(file); reader != readers.end())
                    throw UsageError(fmt::format("{} {} would overwrite the input {}: name another output",
                                                 option, path, reader->second));
                const auto [writer, is_new] = writers.emplace(file, option);
                if (!is_new && writer->second != option)
                    throw UsageError(
                        fmt::format("{} and {} name the same file: {}", writer->second, option, path));
            }
}

} // namespace sparselens
