#include "loading/merged_ldi.h"

#include "io/merge_ldis.h"
#include "loading/notices.h"

namespace sparselens {

namespace {

OpenedLdi open_one(const std::string &path, const OpenOptions &options, const ToolContext &tool) {
    OpenedLdi in = open_ldi(path, options);
    say_samples(tool, in);
    warn_of_invalid_values(tool, path, in.bad);
    return in;
}

} // namespace

OpenedLdi open_merged(const std::vector<std::string> &paths, const OpenOptions &options,
                      const ToolContext &tool) {
    std::vector<OpenedLdi> parts;
    for (const std::string &path : paths) parts.push_back(open_one(path, options, tool));
    return merge_ldis(std::move(parts));
}

} // namespace sparselens
