// A look at the headers of an EXR file before OpenEXR reads them: it allocates what an attribute claims, and finds
// out afterwards that the file is not that long.
//
// Layout: "OpenEXR File Layout" (openexr.com): after magic number and version, attributes of name, type, size and
// value, an empty name ends the header; of several parts another empty name ends the list.
#pragma once

#include "io/files/file_stream.h"

#include <string>

namespace sparselens {

// Error, naming file and attribute, where one is larger than the file or not of its type's size, or where the header
// does not end. What is no EXR file is left for OpenEXR to say. Leaves the stream at its beginning.
void check_header(InputStream &in, const std::string &path);

} // namespace sparselens
