// A request from a page: one JSON object,
// {"page": "k3j9", "settings": {"fstop": "2.8", "quality": "draft"}, "frame": 12, "exposure": 0.5, "pixel": [320,
// 180]}.
#pragma once

#include "options/gather_options.h"

#include <Imath/ImathBox.h>
#include <Imath/ImathVec.h>
#include <nlohmann/json_fwd.hpp>

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace sparselens {

struct PageRequest {
    std::string page; // the page's id: 1 to 32 letters and digits
    // Options of dof-gather without dashes -> their values. An empty value resets the option to the server's command
    // line.
    std::map<std::string, std::string> settings;
    std::optional<int> frame;           // the frame's number in a sequence; empty: the first
    std::string format = "exr";         // file format of the commands: "exr" or "png"
    double exposure = 0;                // stops, [-20, 20]
    std::optional<Imath::V2i> pixel;    // in the picture, EXR coordinates
    std::optional<Imath::Box2i> region; // of the picture: [left, top, right, bottom], the last ones included
};

// Longer requests are refused.
inline constexpr std::size_t most_request_bytes = 16384; // bytes

// Parses a request. Throws UsageError with the reason if the text is invalid. Values may hold only letters, digits and
// "+-.,_", so a page cannot name a file.
PageRequest parse_page_request(std::string_view text);

// Calls the function for each name in an object of JSON with its value. Returns false if there is none for a name.
using ByName = std::map<std::string, std::function<void(const nlohmann::json &value)>>;
bool take_by_name(const nlohmann::json &object, const ByName &functions);

// The picture on a page, as the words of a dof-gather command line: the server's own words, and the page's settings. So
// a page can set only what a command line can say, and every picture has a command.
using Words = std::vector<std::string>;

// Lenses that the page offers (installed_lenses()).
using Presets = std::map<std::string, std::string>;

// The words of a dof-view command line that dof-gather also has: IN, and how the picture is made.
Words picture_words(const Words &all);

// The words with a page's settings (PageRequest::settings) applied; its lens is the name of a preset. Throws UsageError
// if a page may not set an option.
Words words_with(const Words &given, const std::map<std::string, std::string> &settings,
                 const Presets &presets = {});

// The words without the option, and without options that say the same in another way.
Words words_without(const Words &given, const std::string &option);

// The command that the words describe, with a name of the output; OpenImageIO, which loads slowly, is needed for PNG.
// Throws UsageError for an invalid command line.
GatherCommand command_of(const Words &words, const std::string &output = "picture.png");

// The words without the quality that is usual, and without those that do not apply to the output: an EXR file has no
// display.
Words words_for(const Words &given, const std::string &output, const char *usual_quality);

// The command that makes the picture, for a shell, or as a script for Python.
std::string shell_command(const Words &words, const std::string &output);
std::string python_script(const Words &words, const std::string &input, const std::string &output);

} // namespace sparselens
