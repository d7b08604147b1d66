// Takes the one picture of the moments of a shutter: each moment is gathered through its share of the lens points, one
// after the other, and their mean is the picture (shutter/shutter_mean.h). Depth and ids, which have no mean, are those
// of the middle moment, as are the camera and the header. If false colours are asked for, they are those of the middle
// moment.
#pragma once

#include "take_picture.h"

#include <cstddef>
#include <span>
#include <string>

namespace sparselens {

// Takes the picture of a file as take_picture() does; if its name has %s, of the files of a shutter's moments. Files
// that the request names beside it (a holdout, colours, depths) are those of a moment too if their names have %s.
// `keep` only matters for a single file. Throws Error, naming the file, if moments differ in size, channels, colour
// space, or by more of the lens than can change while a shutter is open.
TakenPicture take_moments(LdiCache &cache, bool keep, const PictureRequest &request, const PictureWork &work);

// The same for LDIs in memory, at least one, by their time. One is a still.
TakenPicture take_moments(std::span<const OpenedLdi *const> ldis, const PictureRequest &request,
                          const PictureWork &work);

// The request for the file of the middle moment, if its name has %s; else the same request.
PictureRequest middle_moment(const PictureRequest &request);

// Checks that pictures can be moments of one shutter.
struct NamedPicture {
    std::string name; // of its file, for messages
    const TakenPicture &picture;
};

struct NamedWindows {
    std::string name; // of its file, for messages
    const Windows &windows;
};

// Throws Error, naming both files, if they differ in size.
void require_same_size(const NamedWindows &first, const NamedWindows &other);

// Throws Error, naming both files, if they differ in size, channels or colour space, or by more of the lens than can
// change while a shutter is open.
void require_same_shutter(const NamedPicture &first, const NamedPicture &other);

// Throws Error if the file states that it is another moment than this one of so many.
void require_moment(const NamedPicture &one, std::size_t moment, std::size_t moments);

} // namespace sparselens
