#include "harness/stats.h"

#include "base/error.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace sparselens {

void write_stats(const ToolContext &tool, const Stats &fields) {
    if (tool.stats.empty()) return;
    Stats line{{"tool", tool.tool_name}};
    if (tool.frame) line["frame"] = *tool.frame;
    line.update(fields);
    const std::string text = line.dump() + '\n';
    const bool to_stderr = tool.stats == "-";
    const int file =
        to_stderr ? STDERR_FILENO : open(tool.stats.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    // One call, so that lines of stages that share the file do not mix.
    const bool written = file >= 0 && write(file, text.data(), text.size()) == ssize_t(text.size());
    const int reason = errno;
    if (!to_stderr && file >= 0) close(file);
    if (!written) throw Error(tool.stats + ": cannot write: " + std::strerror(reason));
}

} // namespace sparselens
