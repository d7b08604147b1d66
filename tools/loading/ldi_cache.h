// Keeps the last LDI that was read, so that a pull of focus over one file reads it once.
#pragma once

#include "harness/tool.h"
#include "io/open_ldi.h"
#include "options/colour_options.h"

#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace sparselens {

// A file with samples, and the flat picture of its colours (loading/recoloured.h) or "".
struct LdiNames {
    std::string path, recolor;
};

class LdiCache {
public:
    // Calls open_ldi(), recolor_by(), to_linear() and keep_channels() if the last file was another or was read by other options, and
    // then warns of invalid values. The camera always follows the options given. Earlier results become invalid.
    // Samples that were reduced are read anew the next time.
    OpenedLdi &load(const LdiNames &names, const std::string &channels, const OpenOptions &options,
                    const ColourOptions &colour, const ToolContext &tool, const ChooseSamples &choose = {});

    // The samples of the last load(), which are read anew the next time.
    Ldi take_ldi() {
        taken_ = true;
        return std::move(last_->ldi);
    }

    // The result of the last load(), whether it read the file, and which of its channels were left out.
    const OpenedLdi &last() const { return *last_; }
    bool read_now() const { return read_now_; }
    const std::vector<std::string> &channels_left_out() const { return channels_left_out_; }

private:
    // Everything that the samples depend on. The focal length is part of it, because it makes ray lengths planar.
    using Key =
        std::tuple<std::string, std::string, DepthMeaning, std::optional<double>, std::optional<double>,
                   std::string, std::string, std::string, std::optional<double>, std::optional<double>,
                   std::string, std::string, std::string, std::string, bool>;

    Key key_;
    std::optional<OpenedLdi> last_;
    bool read_now_ = false, taken_ = false;
    std::vector<std::string> channels_left_out_;
};

} // namespace sparselens
