#include "io/files/folder.h"

#include "base/error.h"

#include <filesystem>

namespace sparselens {

void make_folder(const std::string &path) {
    std::error_code error;
    std::filesystem::create_directories(path, error);
    if (error) throw Error(path + ": cannot create the folder: " + error.message());
}

} // namespace sparselens
