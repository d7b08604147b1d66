// Finds the channels of a picture by the names that programs give them: its beauty and its depth.
#pragma once

#include "base/image.h"
#include "io/exr/exr_parts.h"

#include <ImfMultiPartInputFile.h>

#include <optional>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

namespace sparselens {

// The beauty: the layer or part that holds the whole picture. Every renderer names it differently (Blender
// ViewLayer.Combined, RenderMan Ci, Houdini C, Arnold RGBA). Not for use outside io/.

// Whether the last component of a layer's or part's name is one that renderers give to the beauty, in any case.
bool is_beauty_name(std::string_view name);

// The beauty names as a list, for messages.
std::string beauty_names();

// Whether there is an R, G or B outside of all layers.
bool has_plain_colour(const std::vector<Channel> &channels);

// The layers that have R, G and B, in the order of their channels.
std::vector<std::string> colour_layers(const std::vector<Channel> &channels);

// The layers that hold colours, if there is no R, G or B outside of them and no beauty among them; otherwise none.
std::vector<std::string> layers_without_beauty(const std::vector<Channel> &channels);

// Renames the R of `layer` to plain R; likewise G, B, A, AR, AG and AB, unless `channels_of_picture` has a channel of
// that name.
// R, G, B and A come first.
void name_beauty(std::vector<FileChannel> &channels, const std::string &layer,
                 const std::vector<Channel> &channels_of_picture);

// Says which channels of the file are the beauty and its coverage. `part` names where they are; it may be empty.
std::string beauty_note(const std::vector<FileChannel> &channels, const std::string &part);

// A warning that lists the layers if layers_without_beauty() finds any; otherwise nothing.
std::vector<std::string> beauty_warnings(const std::vector<Channel> &channels);

// A file may hold several pictures, each with its own beauty, depth and passes: fg.Combined.R, fg.Depth.Z,
// fg.CryptoObject00.r, ... and bg.Combined.R, bg.Depth.Z, ..., as Blender writes view layers.
struct PictureLayer {
    std::string name;   // "fg": the value of the option `layer`; "rgba" if the beauty lies in no layer
    std::string beauty; // "fg.Combined"
    std::string prefix; // of its channels: "fg."; empty if the beauty lies in no layer
};

// Empty if there is an R, G or B outside of all layers, or no beauty. If some pictures have a depth beside their beauty
// (fg.Depth.Z, fg.Z), only these: the others were made from them, like Blender's Composite.
std::vector<PictureLayer> pictures_in(const std::vector<Channel> &channels);

// The requested picture, by its name, by the name of its beauty, or by the name of any layer of colours; empty if none
// is requested. Throws UsageError, naming all pictures, if there are several and none is requested; Error if the layer
// does not exist.
std::optional<PictureLayer> chosen_picture(const std::vector<Channel> &channels, const std::string &asked,
                                           const std::string &path);

// Decides which channels of a file make up a picture: its own channels, and those that belong to no picture.
class ChannelsOfPicture {
public:
    // `depth`: the channel requested as its depth, in any layer; empty: none.
    ChannelsOfPicture(PictureLayer picture, const std::vector<Channel> &of_file,
                      const std::string &depth = {});

    bool owns(const std::string &channel) const;
    // The channel's name in the picture: R for fg.Combined.R, Z for fg.Z if no depth is requested, otherwise unchanged.
    // Empty if the channel belongs to another picture, or is a depth outside of all layers while the picture has its
    // own depth.
    std::string name_of(const std::string &channel) const;

private:
    bool belongs_to_others(const std::string &channel) const;

    PictureLayer own_;
    std::unordered_set<std::string> others_; // prefixes of other pictures
    std::string depth_;                      // its own; empty if it has none or another is requested
    std::string asked_depth_;
};

// A channel of one of several parts by its full name: R of the part fg.Combined is fg.Combined.R. Channels of a single
// part keep their names.
std::string full_name(const std::string &channel, const std::string &part, bool one_of_several);
std::vector<Channel> full_channels(const Imf::MultiPartInputFile &file, const std::vector<int> &parts,
                                   const std::string &view, const std::string &path);

// Finds the depth channel of a picture. Only this file knows the names that programs give it. Not for use outside io/.
//
// The first of these that exists, in any case: Z; depth.Z; *.Depth.Z; a channel, or the first of a layer, named z,
// depth or zdepth (Z.R, depth.V, zDepth.R). Otherwise it guesses, with a warning: the only LAYER.Z without a LAYER.X,
// or the only channel with "depth" in its name that is no G, B or A.
struct FlatFile; // io/exr/exr_flat.h

struct DepthChannel {
    std::string name;
    std::optional<std::string> warning = {}; // if it is a guess
};

// The channel `asked`, in any case if none is spelled exactly so; if `asked` is empty, the channel found by its name.
// Throws Error, listing the channels, if there is none, or if it holds integers.
DepthChannel find_depth_channel(const std::vector<Channel> &channels, const std::string &asked,
                                const std::string &path);

// Whether there is a depth channel, of any type, that need not be guessed.
bool has_depth_channel(const std::vector<Channel> &channels, const std::string &asked);

// How clearly the name means depth: 0 for Z, more for less clear names; empty if it does not.
std::optional<int> depth_rank(std::string_view name);

// The depth channel. A file that holds only depth may give it any name: Y, or a grey R, G and B.
DepthChannel depth_of(const std::vector<Channel> &channels, const std::string &asked,
                      const std::string &path);

// Reads choice.depth_file, an EXR file.
FlatFile read_depth_file(const PictureChoice &choice);
// Puts the depth of that file into the picture as Z, in place of any depth there. Notes and warnings name what it read.
// The depth is the channel found by its name; otherwise the only channel; otherwise the first of R, G and B. Outside its
// data window it is 0. Throws Error if the file has no depth, or differs from the picture in display window or pixel
// aspect ratio.
void put_depth_of_file(FlatFile &picture, const std::string &path, const PictureChoice &choice,
                       const FlatFile &file);

} // namespace sparselens
