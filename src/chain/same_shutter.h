// Checks that pictures can be moments of one shutter.
#pragma once

#include "chain/take_picture.h"

#include <cstddef>
#include <string>

namespace sparselens {

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
