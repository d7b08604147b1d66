// What happens to each layer of a picture, in words for -v: the list of docs/file-format.md.
#pragma once

#include "../base/image.h"

#include <span>
#include <string>
#include <vector>

namespace sparselens {

// One line a layer, in the order of their first channels.
std::vector<std::string> layer_notes(std::span<const Channel> channels);

} // namespace sparselens
