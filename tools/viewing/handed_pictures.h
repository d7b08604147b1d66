// Flat pictures that another program hands over, where others name a file. Each becomes an EXR file in memory. It has a
// path as long as it is kept, so whatever reads files can read it.
#pragma once

#include "base/image.h"
#include "io/files/memory_file.h"

#include <list>
#include <memory>
#include <string>
#include <vector>

namespace sparselens {

// The layout of such a picture: 32-bit floats of the machine, row by row from the top, each pixel with these channels.
struct HandedLayout {
    Windows windows = {};
    std::vector<std::string> channels = {};
    bool shown = false; // the colours are those of a PNG

    std::size_t bytes() const { return windows.pixels() * channels.size() * sizeof(float); }
    bool operator==(const HandedLayout &) const = default;
};

class HandedPictures {
public:
    // The path of a picture's file. The same picture handed over again has the same file. Throws UsageError if the
    // pixels are not as many bytes as the layout says.
    std::string path_of(const HandedLayout &layout, std::string pixels);

    // The message with words in place of such a path.
    static std::string in_words(std::string message);

private:
    struct Kept {
        HandedLayout layout;
        std::string pixels;
        std::shared_ptr<const MemoryFile> file;
    };
    std::list<Kept> kept_; // the last used first
};

} // namespace sparselens
