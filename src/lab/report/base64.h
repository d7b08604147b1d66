// Base64 of RFC 4648, padded: how a page carries its pictures within itself.
#pragma once

#include <span>
#include <string>

namespace sparselens::lab {

std::string base64(std::span<const char> bytes);

} // namespace sparselens::lab
