#include "lab/reporting/files.h"

#include "io/files/file_stream.h"
#include "io/files/text_file.h"

#include <algorithm>

namespace sparselens::lab {

void write_file(const std::filesystem::path &path, const std::string &contents) {
    make_folder(path.parent_path().string());
    write_text_file(path.string(), contents);
}

std::vector<std::string> matching_files(const std::filesystem::path &pattern) {
    const std::string name = pattern.filename().string();
    const std::size_t star = name.find('*');
    std::vector<std::string> files;
    if (star == std::string::npos || !std::filesystem::is_directory(pattern.parent_path())) return files;
    const std::string head = name.substr(0, star), tail = name.substr(star + 1);
    for (const auto &entry : std::filesystem::directory_iterator(pattern.parent_path())) {
        const std::string file = entry.path().filename().string();
        if (file.size() >= head.size() + tail.size() && file.starts_with(head) && file.ends_with(tail))
            files.push_back(entry.path().string());
    }
    std::ranges::sort(files);
    return files;
}

std::vector<std::string> with_files(const std::vector<std::string> &words, const std::string &folder) {
    std::vector<std::string> result;
    for (const std::string &word : words) {
        const std::filesystem::path path(word);
        if (path.filename().string().find('*') == std::string::npos) {
            result.push_back(word);
            continue;
        }
        for (const std::string &file : matching_files(folder / path))
            result.push_back((path.parent_path() / std::filesystem::path(file).filename()).string());
    }
    return result;
}

} // namespace sparselens::lab
