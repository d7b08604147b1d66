// Pictures of .dof files, asked of a gatherer that all readers of the program share. Throws std::runtime_error with
// the reason in words.
#pragma once

#include <OpenImageIO/imageio.h>

#include <cstddef>
#include <memory>
#include <string>

namespace sparselens_oiio {

inline constexpr std::size_t most_levels = 4;

struct Source {
    std::string file; // .dof, an absolute path
    std::string query = {};
};

// A picture in one of its sizes: level 0 is the full one, each other half of the last one.
struct Level {
    int number = 0, count = 1; // count: of all levels
    OIIO::ImageSpec spec = {}; // what OpenImageIO says of the EXR file that dof-gather writes
};

// Asks for windows, channels and metadata. A picture without tiles has one level.
std::shared_ptr<const Level> read_header(const Source &source, int level);

// Whether it has the size that a file with MIP levels has: half of the last one, rounded up. It has not if overscan is
// no multiple of the smaller pixels.
bool is_level_of(const Level &full, const Level &level);

// Reads pixels in the native layout of the specification. Rows are of the data window, from `first` to before `end`.
// The tile begins at x,y; its pixels beyond the data window are 0. Any number of threads may call them.
void read_rows(const Source &source, const Level &level, int first, int end, void *data);
void read_tile(const Source &source, const Level &level, int x, int y, void *data);

} // namespace sparselens_oiio
