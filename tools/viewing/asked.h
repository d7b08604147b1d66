// What a page asks for, as it sends it: one object of JSON,
// {"page": "k3j9", "settings": {"fstop": "2.8", "quality": "draft"}, "frame": 12, "exposure": 0.5, "pixel": [320, 180]}.
#pragma once

#include <Imath/ImathVec.h>

#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace sparselens {

struct Asked {
    std::string page; // which of the pages that are open; of 1 to 32 letters and digits
    // Options of dof-gather without their dashes, and their values; an empty one puts the option back to what the command
    // line of the server says.
    std::map<std::string, std::string> settings;
    std::optional<int> frame;        // its number, where there are frames; else the first
    std::string format = "exr";      // of the files that commands write: "exr" or "png"
    double exposure = 0;             // stops, [-20, 20]
    std::optional<Imath::V2i> pixel; // of the picture, EXR coordinates
};

// Longer ones are not read.
inline constexpr std::size_t most_asked = 16384; // bytes

// Throws UsageError, which says what is wrong, where the text is anything else. Values are made of letters, digits and
// "+-.,_" alone: no file can be named.
Asked parse_asked(std::string_view text);

} // namespace sparselens
