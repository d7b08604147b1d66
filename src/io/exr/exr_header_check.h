// Checks the headers of an EXR file before OpenEXR reads them, because OpenEXR allocates the memory that an attribute
// claims before it notices that the file is not that long.
//
// The layout is that of "OpenEXR File Layout" (openexr.com): the magic number and the version are followed by
// attributes of name, type, size and value. An empty name ends a header; in a file of several parts another one ends
// the list.
#pragma once

#include "io/files/file_stream.h"

#include <string>

namespace sparselens {

// Throws Error, naming the file and the attribute, if an attribute is larger than the file or does not have the size of
// its type, if the header does not end, or if the file is not an EXR file (not_exr()). A file of fewer than 8 bytes is
// left for OpenEXR to report. Leaves the stream at its beginning.
void check_header(InputStream &in, const std::string &path);

} // namespace sparselens
