// The views on a command line: CENTER.exr [VIEW.exr ...] [--view X,Y VIEW.exr]...
#pragma once

#include "harness/commands/cli.h"

#include <string>
#include <utility>
#include <vector>

namespace sparselens {

struct ViewList {
    std::vector<std::string> files;                          // the centre view first
    std::vector<std::pair<std::string, std::string>> placed; // "X,Y" and a file
};

void add_view_list(CLI::App &app, ViewList &list);

} // namespace sparselens
