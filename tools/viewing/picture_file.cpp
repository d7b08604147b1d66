#include "viewing/picture_file.h"

#include "base/error.h"
#include "base/text.h"
#include "harness/commands/file_arguments.h"
#include "harness/commands/frames.h"
#include "io/files/text_file.h"
#include "io/lens_file.h"
#include "io/moment_files.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace sparselens {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using Settings = std::map<std::string, std::string>;

constexpr std::uintmax_t largest_file = 1 << 20; // bytes of a .dof file
constexpr std::size_t most_settings = 128;
// What a picture for another program has no use for.
constexpr std::array not_settable{"o", "output", "depth-out", "no-history", "help", "h"};

std::string option_of(const std::string &key) { return key == "focus" ? "focus-distance" : key; }

[[noreturn]] void refuse(const std::string &where, const std::string &key, const std::string &what) {
    throw UsageError(fmt::format("{}: {}: {}", where, key, what));
}

// A number, a text, or a pair; empty for other values.
std::string text_of(const Json &value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number()) return value.dump();
    const auto is_number = [](const Json &one) { return one.is_number(); };
    if (value.is_array() && value.size() == 2 && std::ranges::all_of(value, is_number))
        return value[0].dump() + "," + value[1].dump();
    return {};
}

// {"1": 2.5, "24": 4} as the keys of a command line: 1:2.5,24:4; pairs are parted by semicolons.
std::string keys_of(const Json &object) {
    std::string keys;
    for (const auto &[frame, value] : object.items()) {
        const std::string text = value.is_string() ? "" : text_of(value);
        if (text.empty()) return {};
        keys += (keys.empty() ? "" : value.is_array() ? ";" : ",") + frame + ":" + text;
    }
    return keys;
}

// The number at the end of a name, after a dot or a low line: 12 of shot.0012.dof.
std::optional<int> number_at_end(const std::string &file) {
    const std::string stem = fs::path(file).stem().string();
    const std::size_t before = stem.find_last_not_of("0123456789");
    if (before == std::string::npos || std::string_view("._").find(stem[before]) == std::string_view::npos)
        return {};
    return number_of<int>(std::string_view(stem).substr(before + 1));
}

Settings settings_in_query(const std::string &query) {
    Settings settings;
    for (std::size_t from = 0; from < query.size();) {
        const std::size_t to = std::min(query.find('&', from), query.size());
        const std::string part = query.substr(from, to - from);
        const std::size_t equals = part.find('=');
        if (equals == std::string::npos || equals == 0)
            throw UsageError(fmt::format("the query: '{}' is not KEY=VALUE", part));
        if (!settings.emplace(option_of(part.substr(0, equals)), part.substr(equals + 1)).second)
            throw UsageError(fmt::format("the query: {} is given twice", part.substr(0, equals)));
        from = to + 1;
    }
    return settings;
}

// What a .dof file says: the LDI, and settings.
Settings read_dof_file(const std::string &path) {
    std::error_code error;
    if (fs::file_size(path, error) > largest_file && !error)
        throw Error(path + ": is larger than 1 MB, so it is not a .dof file");
    return settings_in(read_json_file(path), path);
}

// A path that does not depend on the current folder.
std::string in_folder(const fs::path &folder, const std::string &path) {
    return fs::absolute(folder / path).lexically_normal().string();
}

// The value of an option as the command line has it: files are found, lenses of share/lenses too.
std::string resolved(const std::string &option, const std::string &value, const fs::path &folder,
                     const Presets &presets) {
    if (value.starts_with('@')) return "@" + in_folder(folder, value.substr(1)); // keys
    if (!is_input_word("--" + option)) return value;
    std::error_code unknown;
    const std::string path = in_folder(folder, value);
    const auto preset = option == "lens" && !fs::exists(path, unknown) ? presets.find(value) : presets.end();
    return preset == presets.end() ? path : preset->second;
}

// Turns settings into words of a command line.
class Setter {
public:
    Setter(fs::path folder, const Presets &presets) : folder_(std::move(folder)), presets_(presets) {
        add_gather_options(known_, unused_);
    }

    // The words with all the settings, which replace earlier words that say the same in another way, but not each
    // other.
    Words set(Words words, const Settings &settings) const {
        Words added;
        for (const auto &[option, value] : settings) {
            const Words own = words_of_one(option, value);
            words = words_without(words, option);
            added.insert(added.end(), own.begin(), own.end());
        }
        words.insert(words.end(), added.begin(), added.end());
        return words;
    }

private:
    Words words_of_one(const std::string &option, const std::string &value) const {
        const std::string word = (option.size() == 1 ? "-" : "--") + option;
        const CLI::Option *known = known_.get_option_no_throw(word);
        if (!known || known->get_positional() || is_among(not_settable, option))
            throw UsageError(option + ": is not a setting of a picture (see dof-gather --help)");
        if (known->get_items_expected_max() == 0) { // a flag
            if (is_among(std::array{"true", "on", "1"}, value)) return {word};
            if (is_among(std::array{"false", "off", "0"}, value)) return {};
            throw UsageError(fmt::format("{}: must be true or false, not '{}'", option, value));
        }
        if (value.starts_with('-') && value.find_first_of("0123456789.i") != 1)
            throw UsageError(fmt::format("{}: '{}' is no value", option, value));
        return {word, resolved(option, value, folder_, presets_)};
    }

    fs::path folder_;
    const Presets &presets_;
    GatherCommand unused_;
    CLI::App known_;
};

// The words at the frame: a file for a sequence, a value for keys.
Words at_frame(Words words, const std::optional<int> &frame) {
    if (frame) words.insert(words.end(), {"--frames", fmt::to_string(*frame)});
    try {
        Words result = FrameCommands(words).words(0);
        if (frame) result.resize(result.size() - 2);
        return result;
    } catch (const UsageError &error) {
        if (frame) throw;
        throw UsageError(std::string(error.what()) +
                         " (the request, the query or the name of the .dof file gives the frame)");
    }
}

// A pipe may never end, and the host would wait for it.
void require_regular(const std::string &file) {
    std::error_code unknown;
    const fs::file_status status = fs::status(file, unknown);
    if (fs::exists(status) && !fs::is_regular_file(status))
        throw UsageError(file + ": is not a regular file");
}

// The moments that a name with %s stands for, or the file of that name; and the aperture that a lens file names.
void add_files(const std::string &option, const std::string &path, std::vector<std::string> &files) {
    if (names_moments(path)) {
        for (const std::string &number : moments_on_disk(path)) files.push_back(at_moment(path, number));
        return;
    }
    require_regular(path);
    files.push_back(path);
    if (std::error_code unknown; option != "--lens" || !fs::is_regular_file(path, unknown)) return;
    if (const std::string aperture = aperture_named_in(path); !aperture.empty()) files.push_back(aperture);
}

} // namespace

Settings settings_in(const Json &object, const std::string &where) {
    if (!object.is_object()) throw UsageError(where + ": is not an object of JSON");
    if (object.size() > most_settings)
        throw UsageError(fmt::format("{}: has more than {} keys", where, most_settings));
    Settings settings;
    for (const auto &[key, value] : object.items()) {
        std::string text = value.is_object() ? keys_of(value) : text_of(value);
        if (value.is_boolean()) text = value.get<bool>() ? "true" : "false";
        if (text.empty())
            refuse(where, key,
                   "must be a number, a text, true or false, [X, Y], or an object of values by frame");
        if (!settings.emplace(option_of(key), text).second) refuse(where, key, "is given twice");
    }
    return settings;
}

Words words_of(const PictureSource &source, const Presets &presets) {
    const bool is_dof = source.file.ends_with(".dof");
    Settings settings = is_dof ? read_dof_file(source.file) : Settings{{"ldi", source.file}};
    const auto ldi = settings.extract("ldi");
    if (!ldi) refuse(source.file, "ldi", "is missing: it names the LDI");
    const fs::path folder = is_dof ? fs::path(source.file).parent_path() : fs::path();
    Words words{in_folder(folder, ldi.mapped())};
    Settings query = settings_in_query(source.query);
    std::optional<int> frame = is_dof ? number_at_end(source.file) : std::nullopt;
    if (const auto given = query.extract("frame")) {
        frame = number_of<int>(given.mapped());
        if (!frame) refuse("the query", "frame", "must be a whole number");
    }
    if (source.frame) frame = source.frame;
    const Setter setter(folder, presets);
    for (const Settings *all : {&std::as_const(settings), &source.settings, &std::as_const(query)})
        words = setter.set(std::move(words), *all);
    for (const std::string &word : words)
        if (word.starts_with('@')) require_regular(word.substr(1)); // keys
    words = at_frame(std::move(words), frame);
    for (const std::string &file : files_in(words)) require_regular(file);
    return words;
}

std::vector<std::string> files_in(const Words &words) {
    std::vector<std::string> files;
    add_files({}, words.front(), files);
    for (std::size_t i = 1; i + 1 < words.size(); ++i)
        if (is_input_word(words[i])) add_files(words[i], words[i + 1], files);
    return files;
}

} // namespace sparselens
