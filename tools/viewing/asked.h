// A request from a page: one JSON object,
// {"page": "k3j9", "settings": {"fstop": "2.8", "quality": "draft"}, "frame": 12, "exposure": 0.5, "pixel": [320,
// 180]}.
#pragma once

#include <Imath/ImathBox.h>
#include <Imath/ImathVec.h>

#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace sparselens {

struct Asked {
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
inline constexpr std::size_t most_asked = 16384; // bytes

// Parses a request. Throws UsageError with the reason if the text is invalid. Values may hold only letters, digits and
// "+-.,_", so a page cannot name a file.
Asked parse_asked(std::string_view text);

} // namespace sparselens
