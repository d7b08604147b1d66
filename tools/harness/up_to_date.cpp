#include "harness/up_to_date.h"

#include <ImfCheckFile.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace sparselens {

namespace {

namespace fs = std::filesystem;

bool is_output(const CLI::Option &option) {
    return option.check_lname("output") || option.check_lname("depth-out");
}

bool is_log(const CLI::Option &option) { return option.check_lname("stats"); }

// Outputs appear whole or not at all; but a full disk elsewhere, or a copy that was stopped, may have left less.
bool is_complete(const fs::path &file) {
    std::error_code error;
    if (!fs::is_regular_file(file, error) || fs::file_size(file, error) == 0) return false;
    return file.extension() != ".exr" || !Imf::checkOpenEXRFile(file.c_str());
}

} // namespace

bool is_up_to_date(const CLI::App &parsed) {
    std::vector<fs::path> outputs, inputs;
    std::error_code error;
    for (const CLI::Option *option : parsed.get_options()) {
        if (is_log(*option)) continue;
        for (const std::string &name : option->results()) {
            if (is_output(*option))
                outputs.emplace_back(name);
            else if (fs::is_regular_file(name, error))
                inputs.emplace_back(name);
        }
    }
    const auto time = [&](const fs::path &file) { return fs::last_write_time(file, error); };
    return !outputs.empty() && std::ranges::all_of(outputs, [&](const fs::path &output) {
        return is_complete(output) && std::ranges::all_of(inputs, [&](const fs::path &input) {
                   return time(input) <= time(output);
               });
    });
}

} // namespace sparselens
