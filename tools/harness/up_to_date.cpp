#include "harness/up_to_date.h"

#include "base/error.h"
#include "harness/history.h"
#include "io/exr/exr_header_check.h"
#include "io/files/file_stream.h"

#include <ImfCheckFile.h>

#include <algorithm>
#include <filesystem>
#include <optional>

namespace sparselens {

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
