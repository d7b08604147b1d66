// Files in ../shared beside the sources, which exist on some machines: pictures that are too large, or not ours, to be
// kept in the repository. Tests that use them are skipped, with a message, where they are absent.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace sparselens {

// The path of a file in that folder (or in $SPARSELENS_SHARED); empty if it is absent.
inline std::string shared_file(const std::string &name) {
    const char *elsewhere = std::getenv("SPARSELENS_SHARED");
    const std::filesystem::path path =
        std::filesystem::path(elsewhere ? elsewhere : SPARSELENS_SHARED_DIR) / name;
    return std::filesystem::exists(path) ? path.string() : std::string();
}

} // namespace sparselens
