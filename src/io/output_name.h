// The names under which pictures may be written. The ending selects the format. A wrong ending is an error, reported
// before any work is done.
#pragma once

#include <string>

namespace sparselens {

enum class OutputKind {
    exr,    // deep pictures, depths, and all else that only EXR can hold
    picture // EXR, or one of the formats for the screen (io/display/shown_picture.h)
};

// Says why the name is wrong, with the list of endings; empty if it is right. `-`, pipes and devices need no ending.
std::string wrong_with_output(const std::string &path, OutputKind kind);

} // namespace sparselens
