// Base64 of RFC 4648, with padding, by which a page embeds its pictures.
#pragma once

#include <span>
#include <string>

namespace sparselens::lab {

std::string base64(std::span<const char> bytes);

} // namespace sparselens::lab
