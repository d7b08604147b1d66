// A request to dof-view --pipe: one line, one JSON object,
// {"ask": "tile", "file": "shot.dof", "query": "fstop=2", "settings": {"focus": 3.4}, "frame": 12, "level": 1, "box": [0, 0,
// 63, 63], "channels": ["R", "G", "B"], "shown": false}.
//
// Instead of naming a file, the asking program can put a flat picture into the file for pixels (viewing/pipe.h) before it
// asks: {"ask": "picture", "picture": {"display": [0, 0, 95, 63], "data": [0, 0, 95, 63], "pixel_aspect": 1, "channels":
// ["R", "G", "B", "A", "Z"], "shown": true}, "settings": {"fstop": 2}}.
#pragma once

#include "base/image.h"
#include "base/kept.h"
#include "io/files/text_file.h"
#include "viewing/picture_file.h"

#include <Imath/ImathBox.h>

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace sparselens {

// The layout of a flat picture that another program hands over, where others name a file: 32-bit floats of the machine,
// row by row from the top, each pixel with these channels.
struct HandedLayout {
    Windows windows = {};
    std::vector<std::string> channels = {};
    bool shown = false; // the colours are those of a PNG

    std::size_t bytes() const { return windows.pixels() * channels.size() * sizeof(float); }
    bool operator==(const HandedLayout &) const = default;
};

// Such pictures. Each becomes an EXR file in memory. It has a path as long as it is kept, so whatever reads files can
// read it.
class InMemoryPictures {
public:
    // The path of a picture's file. The same picture handed over again has the same file. Throws UsageError if the
    // pixels are not as many bytes as the layout says.
    std::string path_of(const HandedLayout &layout, std::string pixels);

    // The message with words in place of such a path.
    static std::string in_words(std::string message);

private:
    static constexpr std::uint64_t most_kept = 4; // programs ask for parts of a few pictures by turns
    Kept<std::pair<HandedLayout, std::string>, std::unique_ptr<const MemoryFile>> kept_{most_kept};
};

enum class Ask { facts, header, picture, tile };

struct PipeRequest {
    Ask ask = Ask::facts;
    PictureSource source = {};
    int level = 0;                        // 0 to 3: 1, 1/2, 1/4 or 1/8 of the size
    std::optional<Imath::Box2i> box = {}; // of a tile, EXR coordinates, with the last pixels included
    std::vector<std::string> channels =
        {}; // of the pixels, in this order; empty: all, in the order of the header
    bool shown =
        false; // the colours of the answer are those of a PNG, by `display` and `view-transform`, unrounded
    std::optional<HandedLayout> handed = {}; // the picture that replaces the file
};

inline constexpr std::size_t longest_request = 65536; // bytes
inline constexpr int most_levels = 4;

// Parses a request. Throws UsageError with the reason if the text is invalid.
PipeRequest parse_pipe_request(std::string_view text);

} // namespace sparselens
