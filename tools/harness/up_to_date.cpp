#include "harness/up_to_date.h"

#include <ImfCheckFile.h>

#include <algorithm>
#include <filesystem>

namespace sparselens {

namespace {

namespace fs = std::filesystem;

// Outputs appear whole or not at all; but a full disk elsewhere, or a copy that was stopped, may have left less.
bool is_complete(const fs::path &file) {
    std::error_code error;
    if (!fs::is_regular_file(file, error) || fs::file_size(file, error) == 0) return false;
    return file.extension() != ".exr" || !Imf::checkOpenEXRFile(file.c_str());
}

} // namespace

bool is_up_to_date(const NamedFiles &files) {
    std::error_code error;
    const auto time = [&](const std::string &file) { return fs::last_write_time(file, error); };
    return !files.outputs.empty() && std::ranges::all_of(files.outputs, [&](const NamedFile &output) {
        return is_complete(output.path) && std::ranges::all_of(files.inputs, [&](const NamedFile &input) {
                   return !fs::is_regular_file(input.path, error) || time(input.path) <= time(output.path);
               });
    });
}

} // namespace sparselens
