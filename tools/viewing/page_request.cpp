#include "viewing/page_request.h"

#include "base/error.h"
#include "base/text.h"
#include "chain/parameters.h"
#include "harness/history.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

namespace sparselens {

namespace {

using Json = nlohmann::json;

constexpr std::size_t most_settings = 64, longest_value = 64, longest_page = 32;

bool is_alphanumeric(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; }
bool is_of_value(char c) {
    return is_alphanumeric(c) || std::string_view("+-.,_").find(c) != std::string_view::npos;
}

[[noreturn]] void refuse(const char *what) { throw UsageError(std::string("the request: ") + what); }

const std::string &text_of(const Json &value, const char *what) {
    if (!value.is_string()) refuse(what);
    return value.get_ref<const std::string &>();
}

std::string page_of(const Json &value) {
    const std::string &page = text_of(value, "page is not a word");
    if (page.empty() || page.size() > longest_page || !std::ranges::all_of(page, is_alphanumeric))
        refuse("page is not a word of at most 32 letters and digits");
    return page;
}

std::map<std::string, std::string> settings_of(const Json &object) {
    if (!object.is_object() || object.size() > most_settings)
        refuse("settings are not an object of at most 64 values");
    std::map<std::string, std::string> settings;
    for (const auto &[name, given] : object.items()) {
        const std::string &value = text_of(given, "a setting is not text");
        if (value.size() > longest_value || !std::ranges::all_of(value, is_of_value))
            refuse("a setting is longer than 64 letters, digits and +-.,_");
        settings[name] = value;
    }
    return settings;
}

std::string format_of(const Json &value) {
    if (value != "exr" && value != "png") refuse("format is neither exr nor png");
    return value.get<std::string>();
}

double exposure_of(const Json &value) {
    constexpr double most = 20;
    if (!value.is_number() || !(std::abs(value.get<double>()) <= most))
        refuse("exposure is not a number from -20 to 20");
    return value.get<double>();
}

bool is_whole(const Json &n) { return n.is_number_integer() && std::abs(n.get<double>()) <= 1 << 30; }

int frame_of(const Json &value) {
    if (!is_whole(value)) refuse("frame is not a whole number");
    return value.get<int>();
}

Imath::V2i pixel_of(const Json &value) {
    if (!value.is_array() || value.size() != 2 || !std::ranges::all_of(value, is_whole))
        refuse("pixel is not two whole numbers");
    return {value[0].get<int>(), value[1].get<int>()};
}

Imath::Box2i region_of(const Json &value) {
    if (!value.is_array() || value.size() != 4 || !std::ranges::all_of(value, is_whole))
        refuse("region is not four whole numbers");
    const Imath::Box2i box({value[0].get<int>(), value[1].get<int>()},
                           {value[2].get<int>(), value[3].get<int>()});
    if (box.isEmpty()) refuse("region is empty");
    return box;
}

} // namespace

bool take_by_name(const Json &object, const ByName &functions) {
    for (const auto &[name, value] : object.items()) {
        const auto found = functions.find(name);
        if (found == functions.end()) return false;
        found->second(value);
    }
    return true;
}

PageRequest parse_page_request(std::string_view text) {
    if (text.size() > most_request_bytes) refuse("it is too long");
    const Json json = Json::parse(text, nullptr, false); // no exceptions
    if (!json.is_object()) refuse("it is not an object of JSON");
    PageRequest wanted;
    const ByName functions{{"page", [&](const Json &value) { wanted.page = page_of(value); }},
                           {"settings", [&](const Json &value) { wanted.settings = settings_of(value); }},
                           {"frame", [&](const Json &value) { wanted.frame = frame_of(value); }},
                           {"format", [&](const Json &value) { wanted.format = format_of(value); }},
                           {"exposure", [&](const Json &value) { wanted.exposure = exposure_of(value); }},
                           {"pixel", [&](const Json &value) { wanted.pixel = pixel_of(value); }},
                           {"region", [&](const Json &value) { wanted.region = region_of(value); }}};
    if (!take_by_name(json, functions)) refuse("it has a name that is unknown");
    if (wanted.page.empty()) refuse("it says no page");
    return wanted;
}

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
    case ParameterForm::number:
        return value == "inf" ? "float('inf')" : value.ends_with('%') ? quoted(value) : value;
    case ParameterForm::pair:
    case ParameterForm::pixel:
    case ParameterForm::box: return "(" + value + ")";
    case ParameterForm::ldi: return "sparselens.open_ldi(" + quoted(value) + ")";
    default: return quoted(value);
    }
}

} // namespace

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
    app.allow_windows_style_options(false); // /views/ldi.exr is a file
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

Words words_for(const Words &given, const std::string &output, const char *usual_quality) {
    const auto quality = std::ranges::find(given, "--quality");
    const bool is_usual = given.end() - quality > 1 && quality[1] == usual_quality;
    const Words words = is_usual ? words_without(given, "quality") : given;
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
