// Text that others had a say in, on its way to a terminal.
#pragma once

#include <cctype>
#include <string>

namespace sparselens {

// One line, whatever a library put into its message or a file into its names; no control character reaches the
// terminal.
inline std::string one_line(std::string text) {
    for (char &c : text)
        if (std::iscntrl(static_cast<unsigned char>(c))) c = ' ';
    while (!text.empty() && text.back() == ' ') text.pop_back();
    return text;
}

} // namespace sparselens
