// Chooses the channels that are carried along.
#pragma once

#include "deep/ldi.h"

#include <string>
#include <vector>

namespace sparselens {

// `list` holds comma-separated channel names ("R"), layers ("diffuse" for all diffuse.*), Cryptomattes ("CryptoObject")
// or "rgba"; if it is empty, all channels are kept. The last part of the name of a layer or a Cryptomatte suffices if no
// other has it ("CryptoObject" for "ViewLayer.CryptoObject"). Keeps these channels, R, G, B, A and the coverage of any of them,
// because coverage and brightness decide how all channels are gathered. Throws UsageError for a name that the file does
// not have.
void keep_channels(Ldi &ldi, const std::string &list);

// The channels of `image` that the list names, without those that were kept only for the gather.
Image chosen_channels(Image image, const std::string &list);

// A warning for each Cryptomatte with too few ranks for the picture, where the lens mixes many objects: if at least 1 %
// of the picture's coverage (A) is lost in pixels that use all ranks.
std::vector<std::string> lost_matte_warnings(const Image &picture);

} // namespace sparselens
