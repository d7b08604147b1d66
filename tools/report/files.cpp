#include "report/files.h"

#include "base/error.h"
#include "io/file_stream.h"

#include <fstream>
#include <iterator>

namespace sparselens {

std::string contents_of_file(const std::filesystem::path &path) {
    std::ifstream in(path, std::ios::binary);
    std::string contents{std::istreambuf_iterator<char>(in), {}};
    if (!in) throw Error(path.string() + ": cannot be read");
    return contents;
}

void write_file(const std::filesystem::path &path, const std::string &contents) {
    std::error_code error;
    std::filesystem::create_directories(path.parent_path(), error);
    if (error) throw Error(path.parent_path().string() + ": cannot make the folder: " + error.message());
    OutputFile file(path.string());
    file.stream().write(contents.data(), int(contents.size()));
    file.commit();
}

} // namespace sparselens
