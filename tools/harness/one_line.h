// Prepares text for a terminal: messages, and text from other programs or files.
#pragma once

#include "base/text.h"

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>

namespace sparselens {

// Returns the text as one line without control characters, whatever a library's message or the names in a file contain.
inline std::string one_line(std::string text) {
    for (char &c : text)
        if (std::iscntrl(static_cast<unsigned char>(c))) c = ' ';
    while (!text.empty() && text.back() == ' ') text.pop_back();
    return text;
}

// Spells the parameters in a message (error.h) as options: --depth inverse.
inline std::string with_options(std::string_view message) {
    return spelled(message, [](const std::string &name, const std::string &value) {
        std::string option = "--" + name;
        std::ranges::replace(option, '_', '-');
        return value.empty() ? option : option + " " + value;
    });
}

} // namespace sparselens
