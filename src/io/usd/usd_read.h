// Reads textual layers of Universal Scene Description (.usda), by the grammar of OpenUSD's "Usda File Format".
#pragma once

#include "io/usd/usd_layer.h"

#include <string>

namespace sparselens {

// Throws Error, naming the file and the line, if the file cannot be read, is not textual USD, is nested deeper than 64
// levels, or has more than 10,000 cameras and settings or a million time samples. Binary files (.usdc, .usdz) are
// refused with the command that converts them. `-` is standard input.
UsdLayer read_usd(const std::string &path);

} // namespace sparselens
