// Base64 of RFC 4648, with padding, for pictures embedded in a page.
#pragma once

#include <span>
#include <string>

namespace sparselens::lab {

std::string base64(std::span<const char> bytes);

} // namespace sparselens::lab
