// Chooses the channels that are carried along.
#pragma once

#include "deep/ldi.h"

#include <string>

namespace sparselens {

// `list` holds comma-separated channel names ("R"), layers ("diffuse" for all diffuse.*), Cryptomattes ("CryptoObject")
// or "rgba"; if it is empty, all channels are kept. Keeps these channels, R, G, B, A and the coverage of any of them,
// because coverage and brightness decide how all channels are gathered. Throws UsageError for a name that the file does
// not have.
void keep_channels(Ldi &ldi, const std::string &list);

// The channels of `image` that the list names, without those that were kept only for the gather.
Image chosen_channels(Image image, const std::string &list);

} // namespace sparselens
