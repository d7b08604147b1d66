// Opens the LDI of a picture and keeps the last one, so that pulling focus over one file reads it only once.
#pragma once

#include "../io/open_ldi.h"
#include "colours.h"

#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace sparselens {

// A file with samples, and what to read from it.
struct LdiRequest {
    std::string input = {}, recolor = {}; // `recolor`: the flat picture with its colours, or ""
    std::string channels = {};            // comma-separated (channels.h); empty: all
    LensValues lens = {};                 // override the file's values
    DepthOptions depth = {};
    ColourOptions colour = {};
};

class LdiCache {
public:
    // Opens, recolours and makes linear the requested file, if the last file was another, was read with other options,
    // or has been used up since. Channels that are not requested are left out. The camera is that of the file alone,
    // without `lens`. Earlier results become invalid.
    OpenedLdi &load(const LdiRequest &request, const Tell &tell, const ChooseSamples &choose = {});

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
    bool holds(const Key &key) const;

    Key key_;
    std::optional<OpenedLdi> last_;
    bool read_now_ = false;
    std::vector<std::string> channels_left_out_;
};

} // namespace sparselens
