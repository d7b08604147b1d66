// Chooses the picture to read if a file holds several: views of a stereo file ("left", "right", ...), and layers that
// are pictures, such as Blender's view layers (exr_beauty.h). Also chooses the depth channel, and says whether colours
// are premultiplied.
#pragma once

#include <string>
#include <vector>

namespace sparselens {

struct PictureChoice {
    std::string stereo_view = {}; // empty: the file's first
    std::string layer = {};       // empty: the only one
    std::string depth = {};       // a channel of any layer; empty: found by its name (depth_channel.h)
    // A flat file with the same display window, whose depth replaces that of the picture; `depth` then names one of its
    // channels.
    std::string depth_file = {};
    bool unpremultiplied = false; // colours are not yet multiplied by their coverage; the reader does it

    // The depth channel of the picture in memory.
    std::string depth_in_memory() const { return depth_file.empty() ? depth : "Z"; }
};

// The views of all parts, the default view first; empty if the file names none. Reads only the header. Throws Error if
// the file cannot be read.
std::vector<std::string> stereo_views(const std::string &path);

// The layers of a view that are pictures; empty if there are none. Reads only the header. Throws Error like
// stereo_views().
std::vector<std::string> picture_layers(const std::string &path, const std::string &stereo_view = {});

} // namespace sparselens
