// Text from other programs or files that is printed to a terminal.
#pragma once

#include <cctype>
#include <string>

namespace sparselens {

// The text as one line without control characters, whatever the message of a library or the names in a file contain.
inline std::string one_line(std::string text) {
    for (char &c : text)
        if (std::iscntrl(static_cast<unsigned char>(c))) c = ' ';
    while (!text.empty() && text.back() == ' ') text.pop_back();
    return text;
}

} // namespace sparselens
