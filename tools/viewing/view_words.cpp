#include "viewing/view_words.h"

#include "base/error.h"
#include "base/text.h"
#include "chain/parameters.h"
#include "harness/history.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>
#include <system_error>

namespace sparselens {

namespace {

// Options that only dof-view has; the flags take no value.
constexpr std::array own_options{"--reference", "--plate",   "--port",      "--save",
                                 "--frames",    "--threads", "--max-memory"};
constexpr std::array own_flags{"--open", "--pipe", "-v", "--verbose"};

const Parameter *parameter_of(const std::string &option) {
    return option.starts_with("--") ? find_parameter(option.substr(2)) : nullptr;
}
bool takes_no_value(const std::string &option) {
    const Parameter *row = parameter_of(option);
    return is_among(own_flags, option) || (row && row->form == ParameterForm::flag);
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
        else if (!has_own_value(words[i]) && !takes_no_value(name))
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

// Spells a value as a keyword argument in Python.
std::string python_value(ParameterForm form, const std::string &value) {
    switch (form) {
    case ParameterForm::flag: return "True";
    case ParameterForm::whole:
    case ParameterForm::number: return value == "inf" ? "float('inf')" : value;
    case ParameterForm::pair:
    case ParameterForm::pixel:
    case ParameterForm::box: return "(" + value + ")";
    case ParameterForm::ldi: return "sparselens.open_ldi(" + quoted(value) + ")";
    default: return quoted(value);
    }
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

Words words_without(const Words &given, const std::string &option) {
    const std::string name = (option.size() == 1 ? "-" : "--") + option;
    return without(given, [&](const std::string &other) {
        const Parameter *of_other = parameter_of(other);
        return other == name || (of_other && exclude(option, of_other->name));
    });
}

Words words_with(const Words &given, const std::map<std::string, std::string> &settings,
                 const Presets &presets) {
    Words words = given;
    for (const auto &setting : settings) {
        const std::string &option = setting.first, &value = setting.second;
        const auto preset = option == "lens" ? presets.find(value) : presets.end();
        const Parameter *row = find_parameter(option);
        const bool settable = row && row->page;
        if (!settable && !(option == "lens" && value.empty()) && preset == presets.end())
            throw UsageError("the request: a page may not set " + option + " to " + value);
        if (value.empty()) continue;
        words = words_without(words, option);
        words.push_back("--" + option);
        if (!takes_no_value(words.back())) words.push_back(preset == presets.end() ? value : preset->second);
    }
    return words;
}

GatherCommand command_of(const Words &words, const std::string &output) {
    GatherCommand options;
    CLI::App app("", "dof-gather");
    add_gather_options(app, options);
    Words all = words;
    all.insert(all.end(), {"-o", output});
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
    std::string missing;
    std::map<PythonCall, std::string> given;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const std::string option = name_of(words[i]);
        const Parameter *row = parameter_of(option);
        if (!row) continue;
        std::string value;
        if (has_own_value(words[i]))
            value = words[i].substr(option.size() + 1);
        else if (!takes_no_value(option) && i + 1 < words.size())
            value = words[++i];
        if (row->python == PythonCall::none)
            missing += fmt::format("# {} {} is of dof-gather alone\n", option, value);
        else
            given[row->python] += ", " + keyword_of(row->name) + "=" + python_value(row->form, value);
    }
    return fmt::format(
        "import sparselens\n{}ldi = sparselens.open_ldi({}{})\npicture = sparselens.gather(ldi{})\n"
        "sparselens.write({}, picture{})\n",
        missing, quoted(input), given[PythonCall::open_ldi], given[PythonCall::gather], quoted(output),
        given[PythonCall::write]);
}

} // namespace sparselens
