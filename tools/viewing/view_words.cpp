#include "viewing/view_words.h"

#include "base/error.h"
#include "base/text.h"
#include "harness/history.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>

namespace sparselens {

namespace {

// Options that only dof-view has; the flags take no value.
constexpr std::array own_options{"--reference", "--port", "--save", "--frames", "--threads", "--max-memory"};
constexpr std::array own_flags{"--open", "-v", "--verbose"};
// Picture options of dof-gather that take no value.
constexpr std::array picture_flags{"--cat-eye-darkening", "--holdout-defocused", "--unpremultiplied"};

// Options that a page may set, besides the looks that are numbers.
constexpr std::array settable{
    "fstop",      "lens-radius", "focus-distance",       "quality",          "proxy", "show",
    "lens-point", "tilt",        "axial-chromatic-type", "cat-eye-darkening"};

// Setting `option` removes `other`, which says the same in another way.
struct InPlaceOf {
    const char *option, *other;
};
constexpr InPlaceOf in_place_of[] = {{"focus-distance", "--focus-pixel"}, {"fstop", "--lens-radius"},
                                     {"lens-radius", "--fstop"},          {"blades", "--aperture"},
                                     {"blade-curvature", "--aperture"},   {"blade-rotation", "--aperture"}};

bool is_settable(const std::string &option) {
    if (is_among(settable, option)) return true;
    for (const auto table : {look_numbers(), highlight_numbers()})
        if (std::ranges::any_of(table, [&](const LookNumber &number) { return option == number.name; }))
            return true;
    return false;
}

std::string name_of(const std::string &word) { return word.substr(0, word.find('=')); }
bool has_own_value(const std::string &word) { return word.find('=') != std::string::npos; }

// The words without the options that `leaves` accepts and their values, which may be the next word.
template <typename Leaves>
Words without(const Words &words, const Leaves &leaves) {
    Words kept;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const std::string name = name_of(words[i]);
        if (!words[i].starts_with('-') || !leaves(name))
            kept.push_back(words[i]);
        else if (!has_own_value(words[i]) && !is_among(own_flags, name) && !is_among(picture_flags, name))
            ++i;
    }
    return kept;
}

std::string quoted(const std::string &text) {
    std::string result = "'";
    for (const char c : text) {
        if (c == '\'' || c == '\\') result += '\\';
        result += c;
    }
    return result + "'";
}

bool is_number(const std::string &text) {
    char *end = nullptr;
    std::strtod(text.c_str(), &end);
    return !text.empty() && *end == '\0' && std::isalpha(static_cast<unsigned char>(text.back())) == 0;
}

// Spells a value as a keyword argument in Python: numbers as they are, pairs in brackets, all else as text.
std::string python_value(const std::string &option, const std::string &value) {
    if (is_among(picture_flags, option)) return "True";
    if (option == "--holdout") return "sparselens.open_ldi(" + quoted(value) + ")";
    if (value == "inf") return "float('inf')";
    if (is_number(value)) return value;
    if (option == "--tilt" || option == "--focus-pixel") return "(" + value + ")";
    return quoted(value);
}

} // namespace

Presets lens_presets() {
    Presets presets;
    std::error_code unknown;
    const auto folder = std::filesystem::read_symlink("/proc/self/exe", unknown).parent_path().parent_path();
    for (const auto &lenses : {folder / "share/sparselens/lenses", folder.parent_path() / "share/lenses"})
        for (const auto &file : std::filesystem::directory_iterator(lenses, unknown))
            if (file.path().extension() == ".json")
                presets.emplace(file.path().stem().string(), file.path().string());
    return presets;
}

Words picture_words(const Words &all) {
    return without(all, [](const std::string &name) {
        return is_among(own_options, name) || is_among(own_flags, name);
    });
}

Words words_with(const Words &given, const std::map<std::string, std::string> &settings,
                 const Presets &presets) {
    Words words = given;
    for (const auto &setting : settings) {
        const std::string &option = setting.first, &value = setting.second;
        const auto preset = option == "lens" ? presets.find(value) : presets.end();
        if (!is_settable(option) && !(option == "lens" && value.empty()) && preset == presets.end())
            throw UsageError("the request: a page may not set " + option + " to " + value);
        if (value.empty()) continue;
        const std::string name = "--" + option;
        words = without(words, [&](const std::string &other) {
            return other == name || std::ranges::any_of(in_place_of, [&](const InPlaceOf &pair) {
                       return option == pair.option && other == pair.other;
                   });
        });
        words.push_back(name);
        if (!is_among(picture_flags, name)) words.push_back(preset == presets.end() ? value : preset->second);
    }
    return words;
}

GatherCommand command_of(const Words &words) {
    GatherCommand options;
    CLI::App app("", "dof-gather");
    add_gather_options(app, options);
    Words all = words;
    all.insert(all.end(), {"-o", "picture.png"});
    std::ranges::reverse(all); // as CLI11 wants them
    try {
        app.parse(std::move(all));
    } catch (const CLI::ParseError &error) {
        throw UsageError(error.what());
    }
    return options;
}

Words words_for(const Words &words, const std::string &output) {
    if (!output.ends_with(".exr")) return words;
    return without(words,
                   [](const std::string &name) { return name == "--display" || name == "--view-transform"; });
}

std::string shell_command(const Words &words, const std::string &output) {
    return command_line("dof-gather", words) + " -o" +
           command_line("", {output}); // quoted if needed, after a blank
}

std::string python_script(const Words &words, const std::string &input, const std::string &output) {
    constexpr std::array of_file{"--depth",      "--near",        "--far",   "--depth-channel",
                                 "--depth-file", "--stereo-view", "--layer", "--unpremultiplied"};
    constexpr std::array of_output{"--colorconfig", "--display", "--view-transform"};
    constexpr std::array of_tools{"--colorspace", "--output-colorspace", "--show", "--lens-point"};
    std::string opened, gathered, written, missing;
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (!words[i].starts_with("--")) continue;
        const std::string option = name_of(words[i]);
        std::string value;
        if (has_own_value(words[i]))
            value = words[i].substr(option.size() + 1);
        else if (!is_among(picture_flags, option) && i + 1 < words.size())
            value = words[++i];
        std::string keyword = option.substr(2);
        std::ranges::replace(keyword, '-', '_');
        const std::string text = ", " + keyword + "=" + python_value(option, value);
        if (is_among(of_tools, option))
            missing += fmt::format("# {} {} is of dof-gather alone\n", option, value);
        else if (is_among(of_file, option))
            opened += text;
        else if (is_among(of_output, option))
            written += text;
        else
            gathered += text;
    }
    return fmt::format(
        "import sparselens\n{}ldi = sparselens.open_ldi({}{})\npicture = sparselens.gather(ldi{})\n"
        "sparselens.write({}, picture{})\n",
        missing, quoted(input), opened, gathered, quoted(output), written);
}

} // namespace sparselens
