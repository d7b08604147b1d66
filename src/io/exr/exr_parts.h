// The parts of a file, the views of a stereo file ("left", "right", ...), and which parts and channels are whose. Not
// for use outside io/.
//
// Parts say their view by the attribute `view`; a single part may hold several views, which `multiView` lists, the
// default first ("Storing Multi-View Images in OpenEXR Files", P. Hillman, F. Kainz, 2007). There VIEW.R and
// LAYER.VIEW.R, or as others write it VIEW.LAYER.R, are R and LAYER.R of the view; R alone is the default view's; a
// layer whose name holds no view is of all views that have none of that name of their own.
#pragma once

#include "base/image.h"

#include <ImfHeader.h>
#include <ImfMultiPartInputFile.h>

#include <string>
#include <vector>

namespace sparselens {

// The part's name without its view, which the file format makes part of it: "diffuse" of "diffuse.left".
std::string layer_of(const Imf::Header &header);

// Whether the part bears a name that renderers give to the beauty, or none.
bool is_beauty(const Imf::Header &header);

// The views that are in a part, the default first. Empty: it does not say.
std::vector<std::string> views_of(const Imf::Header &header);

// Of the parts `numbers`, those of the view: `asked`, else the default view of the first of them (all that name no
// view, if that one names none). Error, listing the views of those parts: there is none of the name asked for.
struct PartsOfView {
    std::string view; // empty: the file has none
    std::vector<int> numbers;
};
PartsOfView parts_of_view(const Imf::MultiPartInputFile &file, const std::vector<int> &numbers,
                          const std::string &asked, const std::string &path);

// A channel as the file names it and as the picture of one view does.
struct FileChannel {
    std::string in_file;
    Channel channel;
};

// The part's channels in the view, R, G, B, A first, then by name. Error where one of them is subsampled.
std::vector<FileChannel> channels_of(const Imf::Header &header, const std::string &view,
                                     const std::string &path);

// The header of a picture of that view alone.
Imf::Header header_of_view(const Imf::Header &header, const std::string &view);

} // namespace sparselens
