// The last LDI read: a pull of focus over one file reads it once.
#pragma once

#include "harness/tool.h"
#include "io/open_ldi.h"
#include "options/colour_options.h"

#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace sparselens {

class LdiCache {
public:
    // open_ldi(), to_linear() and keep_channels() where the last file was another or was read otherwise; warns
    // of invalid values then. The camera is always by the options given. What was returned before is gone.
    OpenedLdi &load(const std::string &path, const std::string &channels, const OpenOptions &options,
                    const ColourOptions &colour, const ToolContext &tool);

    // Of the last load(): what it returned, whether it read the file, and which channels of it were left out.
    const OpenedLdi &last() const { return *last_; }
    bool read_now() const { return read_now_; }
    const std::vector<std::string> &channels_left_out() const { return channels_left_out_; }

private:
    // All that the samples depend on: depth as ray distance becomes planar by the focal length.
    using Key = std::tuple<std::string, std::string, DepthMeaning, std::string, double, std::string,
                           std::optional<double>, std::optional<double>, std::string, std::string>;

    Key key_;
    std::optional<OpenedLdi> last_;
    bool read_now_ = false;
    std::vector<std::string> channels_left_out_;
};

} // namespace sparselens
