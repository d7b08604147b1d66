// The beauty: the layer or part that holds the whole picture, which every renderer names differently (Blender
// ViewLayer.Combined, RenderMan Ci, Houdini C, Arnold RGBA). Not for use outside io/.
#pragma once

#include "io/exr/exr_parts.h"

#include <ImfMultiPartInputFile.h>

#include <optional>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

namespace sparselens {

// Whether the last component of a layer's or part's name is one that renderers give to the beauty, in any case.
bool is_beauty_name(std::string_view name);

// The beauty names as a list, for messages.
std::string beauty_names();

// Whether there is an R, G or B outside of all layers.
bool has_plain_colour(const std::vector<Channel> &channels);

// The layers that have R, G and B, in the order of their channels.
std::vector<std::string> colour_layers(const std::vector<Channel> &channels);

// The layers that hold colours, if there is neither an R, G or B outside of them nor a beauty among them, else none.
std::vector<std::string> layers_without_beauty(const std::vector<Channel> &channels);

// R of `layer` becomes R; likewise G, B, A, AR, AG and AB, where `channels_of_picture` has no channel of that name. R,
// G, B and A come first.
void name_beauty(std::vector<FileChannel> &channels, const std::string &layer,
                 const std::vector<Channel> &channels_of_picture);

// Which channels of the file are the beauty and its coverage, in words. `part` names where they are; it may be empty.
std::string beauty_note(const std::vector<FileChannel> &channels, const std::string &part);

// A warning that lists the layers, where there are any without a beauty, else nothing.
std::vector<std::string> beauty_warnings(const std::vector<Channel> &channels);

// A file may hold several pictures, each with a beauty, a depth and passes of its own: fg.Combined.R, fg.Depth.Z,
// fg.CryptoObject00.r, ... and bg.Combined.R, bg.Depth.Z, ..., as Blender writes view layers.
struct PictureLayer {
    std::string name;   // "fg": what `layer` takes; "rgba" where the beauty lies in no layer
    std::string beauty; // "fg.Combined"
    std::string prefix; // of its channels: "fg."; empty: the beauty lies in no layer
};

// Empty where there is an R, G or B outside of all layers, or no beauty. Where some have a depth beside their beauty
// (fg.Depth.Z, fg.Z), these: the others were made of them, as Blender's Composite is.
std::vector<PictureLayer> pictures_in(const std::vector<Channel> &channels);

// The picture asked for: by its name, that of its beauty, or as the name of any layer of colours; none if nothing is asked
// for. Throws UsageError, naming all, where nothing is asked for and there are several; Error where there is no such layer.
std::optional<PictureLayer> chosen_picture(const std::vector<Channel> &channels, const std::string &asked,
                                           const std::string &path);

// Which channels of a file make up a picture of it: its own, and those that belong to no picture.
class ChannelsOfPicture {
public:
    // `depth`: the channel asked for as its depth, whichever layer it is of; empty: none.
    ChannelsOfPicture(PictureLayer picture, const std::vector<Channel> &of_file,
                      const std::string &depth = {});

    bool owns(const std::string &channel) const;
    // The name in the picture: R of fg.Combined.R, Z of fg.Z where no depth is asked for, else the same. Empty: the channel belongs to another picture, or
    // is a depth outside of all layers where the picture has one of its own.
    std::string name_of(const std::string &channel) const;

private:
    bool belongs_to_others(const std::string &channel) const;

    PictureLayer own_;
    std::unordered_set<std::string> others_; // prefixes of other pictures
    std::string depth_;                      // its own; empty: it has none, or another is asked for
    std::string asked_depth_;
};

// The channels of several parts of one file by full names: R of the part fg.Combined is fg.Combined.R. Those of the only
// part are as they are.
std::string full_name(const std::string &channel, const std::string &part, bool one_of_several);
std::vector<Channel> full_channels(const Imf::MultiPartInputFile &file, const std::vector<int> &parts,
                                   const std::string &view, const std::string &path);

} // namespace sparselens
