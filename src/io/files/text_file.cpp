#include "io/files/text_file.h"

#include "io/files/file_stream.h"

#include <algorithm>
#include <limits>

namespace sparselens {

namespace {

// The most bytes that OpenEXR's streams take at once.
constexpr std::size_t most_at_once = std::numeric_limits<int>::max();

std::string contents_of(const std::string &path, Content content) {
    const auto stream = open_input(path, content);
    std::string contents(std::size_t(stream->size()), '\0');
    for (std::size_t done = 0; done < contents.size();) {
        const std::size_t count = std::min(contents.size() - done, most_at_once);
        stream->read(contents.data() + done, int(count));
        done += count;
    }
    return contents;
}

} // namespace

std::string read_text_file(const std::string &path) { return contents_of(path, Content::text); }
std::string read_bytes(const std::string &path) { return contents_of(path, Content::bytes); }

void write_text_file(const std::string &path, std::string_view contents) {
    OutputFile file(path);
    while (!contents.empty()) {
        const std::size_t count = std::min(contents.size(), most_at_once);
        file.stream().write(contents.data(), int(count));
        contents.remove_prefix(count);
    }
    file.commit();
}

} // namespace sparselens
