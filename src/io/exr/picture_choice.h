// Which picture of a file is read where it holds several: the views of a stereo file ("left", "right", ...), and layers that
// are a picture each, as the view layers of Blender are (exr_beauty.h). And which of its channels is the depth, and whether its
// colours are premultiplied.
#pragma once

#include <string>
#include <vector>

namespace sparselens {

struct PictureChoice {
    std::string stereo_view = {}; // empty: the file's first
    std::string layer = {};       // empty: the only one
    std::string depth = {};       // a channel, of any layer; empty: the one that names tell (depth_channel.h)
    // A flat file of the same display window, whose depth takes the place of the picture's; `depth` is a channel of it then.
    std::string depth_file = {};
    bool unpremultiplied = false; // colours are not multiplied by their coverage yet: they will be

    // The depth channel of the picture in memory, as `depth` says it.
    std::string depth_in_memory() const { return depth_file.empty() ? depth : "Z"; }
};

// The views of all parts, the default view first; empty if the file names none. Reads only the header. Throws Error if
// the file cannot be read.
std::vector<std::string> stereo_views(const std::string &path);

// The layers of a view that are a picture each; empty where none is. Reads only the header. Throws Error as above.
std::vector<std::string> picture_layers(const std::string &path, const std::string &stereo_view = {});

} // namespace sparselens
