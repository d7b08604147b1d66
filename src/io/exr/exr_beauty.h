// The beauty: the layer or part that holds the whole picture, which every renderer names differently (Blender
// ViewLayer.Combined, RenderMan Ci, Houdini C, Arnold RGBA). Not for use outside io/.
#pragma once

#include "io/exr/exr_parts.h"

#include <string>
#include <string_view>
#include <vector>

namespace sparselens {

// Whether the last component of a layer's or part's name is one that renderers give to the beauty, in any case.
bool is_beauty_name(std::string_view name);

// The beauty names as a list, for messages.
std::string beauty_names();

// The layer whose R, G and B stand for those of the picture: empty where there is an R, G or B outside of all layers, or
// where no layer of colours has the name of a beauty. Of several, that with a depth beside it (ViewLayer.Combined and
// ViewLayer.Depth.Z), else the first.
std::string beauty_layer(const std::vector<Channel> &channels);

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

} // namespace sparselens
