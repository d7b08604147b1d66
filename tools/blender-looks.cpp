// blender-looks: prints the looks that the panel of the Blender add-on has, as JSON: its looks.json. A build runs it and
// installs what it prints; it is not installed itself.
#include "viewing/sequence.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>

using namespace sparselens;

namespace {

// Blender's own fields; and the names of lenses, for which the add-on has a file.
constexpr std::array left_out{"blades", "blade-rotation", "squeeze", "lens"};

} // namespace

int main() {
    std::string text;
    for (const nlohmann::json &told : look_controls({})) {
        if (std::ranges::find(left_out, told["name"].get<std::string>()) != left_out.end()) continue;
        nlohmann::ordered_json look;
        for (const char *key : {"name", "label", "help", "control"}) look[key] = told[key];
        if (told["control"] == "choice") look["words"] = told["words"];
        if (told["control"] == "number")
            for (const char *key : {"low", "high", "usual"}) look[key] = told[key];
        text += (text.empty() ? "[\n  " : ",\n  ") + look.dump();
    }
    std::printf("%s\n]\n", text.c_str());
}
