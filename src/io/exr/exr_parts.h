// The parts of a file and the views of a stereo file ("left", "right", ...): which parts and channels belong to which
// view. Not for use outside io/.
//
// The attribute `view` names the view of a part. A single part may hold several views, which `multiView` lists, the
// default view first ("Storing Multi-View Images in OpenEXR Files", P. Hillman, F. Kainz, 2007). In such a part VIEW.R
// and LAYER.VIEW.R (or VIEW.LAYER.R, as some write it) are R and LAYER.R of the view, and R alone belongs to the
// default view. A layer whose name contains no view belongs to all views that lack a layer of that name. Without
// `multiView`, a layer named as one eye with a depth of its own is that eye's view, and R alone is the other eye.
#pragma once

#include "../../base/image.h"

#include <ImfHeader.h>
#include <ImfMultiPartInputFile.h>

#include <string>
#include <vector>

namespace sparselens {

// The name of the part without its view, which the file format includes: "diffuse" of "diffuse.left".
std::string layer_of(const Imf::Header &header);

// Whether the part has one of the names of a beauty (exr_channels.h), or no name.
bool is_beauty(const Imf::Header &header);

// The views of a part, the default first. Empty if the part names none.
std::vector<std::string> views_of(const Imf::Header &header);

// The views of the parts `numbers`, each once.
std::vector<std::string> all_views(const Imf::MultiPartInputFile &file, const std::vector<int> &numbers);

// The parts among `numbers` that belong to the view `asked`, or if that is empty, to the default view of the first part
// (if it has no view attribute, all parts without one). Throws Error, listing the views of the parts, if no view has
// that name.
struct PartsOfView {
    std::string view; // empty: the file names none
    std::vector<int> numbers;
};
PartsOfView parts_of_view(const Imf::MultiPartInputFile &file, const std::vector<int> &numbers,
                          const std::string &asked, const std::string &path);

// A channel by its name in the file and as a channel of the picture of one view.
struct FileChannel {
    std::string in_file;
    Channel channel;
    std::string kept =
        {}; // the name that it keeps in files if the picture knows it by another (exr_common.h)
};

// Gives the channel another name. If the new name is in a layer, the name that it keeps in files moves to that layer.
void rename(FileChannel &channel, const std::string &name);

// Records in the header which names the channels keep.
void keep_names(Imf::Header &header, const std::vector<FileChannel> &channels);

// The channels of the part in the view: R, G, B, A first, then by name. Throws Error if one is subsampled.
std::vector<FileChannel> channels_of(const Imf::Header &header, const std::string &view,
                                     const std::string &path);

// R, G, B and A go first; the others keep their order.
void colours_first(std::vector<FileChannel> &channels);

// The header for a picture of that view alone.
Imf::Header header_of_view(const Imf::Header &header, const std::string &view);

// Chooses the picture to read if a file holds several: views of a stereo file ("left", "right", ...), and layers that
// are pictures, such as Blender's view layers (exr_channels.h). Also chooses the depth channel, and says whether colours
// are premultiplied.
struct PictureChoice {
    std::string stereo_view = {}; // empty: the file's first
    std::string layer = {};       // empty: the only one
    std::string depth = {};       // a channel of any layer; empty: found by its name (exr_channels.h)
    // A flat file with the same display window, whose depth replaces that of the picture; `depth` then names one of its
    // channels.
    std::string depth_file = {};
    std::string data = {},
                light = {}; // layers or channels of that kind, separated by commas (base/channel_kind.h)
    bool unpremultiplied = false; // colours are not yet multiplied by their coverage; the reader does it

    bool operator==(const PictureChoice &) const = default;

    // The depth channel of the picture in memory.
    std::string depth_in_memory() const { return depth_file.empty() ? depth : "Z"; }
};

// The views of all parts, the default view first; empty if the file names none. Reads only the header.
std::vector<std::string> stereo_views(const std::string &path);

// The layers of a view that are pictures; empty if there are none. Reads only the header.
std::vector<std::string> picture_layers(const std::string &path, const std::string &stereo_view = {});

} // namespace sparselens
