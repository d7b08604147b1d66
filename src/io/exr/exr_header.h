// The attributes of an EXR header as numbers and texts, by names that do not depend on the program that wrote them; and
// changes to them.
#pragma once

#include "io/files/file_stream.h"

#include <ImfAttribute.h>
#include <ImfHeader.h>

#include <optional>
#include <string>
#include <vector>

namespace sparselens {

struct HeaderValue {
    std::string name; // as the file spells it
    // In lower case, without the prefixes "exr/", "nuke/", "input/" and "openexr:" of Nuke and OpenImageIO.
    std::string key;
    // The elements of a number, vector, box (min, max) or matrix (row by row). For a text that consists of numbers
    // ("1,0,0", "{1 0 0}"), these numbers; otherwise empty.
    std::vector<double> numbers;
    std::string text;
};

std::vector<HeaderValue> header_values(const Imf::Header &header);

// The first value whose key is `name`, in any case, or null. A * in `name` stands for one part between slashes.
const HeaderValue *find_value(const std::vector<HeaderValue> &values, const std::string &name);

// The text of that attribute; empty if there is none.
std::string text_attribute(const Imf::Header &header, const char *name);

// The header without the attribute of that name, which must not be one that every header has. In OpenEXR 3.1
// Header::erase() leaks what it removes.
Imf::Header without_attribute(const Imf::Header &header, const std::string &name);

// Sets the attribute, replacing any attribute of that name, whatever its type, at which Header::insert() throws.
void set_attribute(Imf::Header &header, const std::string &name, const Imf::Attribute &attribute);

// Checks the headers of an EXR file before OpenEXR reads them, because OpenEXR allocates the memory that an attribute
// claims before it notices that the file is not that long.
//
// The layout is that of "OpenEXR File Layout" (openexr.com): the magic number and the version are followed by
// attributes of name, type, size and value. An empty name ends a header; in a file of several parts another one ends
// the list.

// Throws Error, naming the file and the attribute, if an attribute is larger than the file or does not have the size of
// its type, if the header does not end, or if the file is not an EXR file (not_exr()). A file of fewer than 8 bytes is
// left for OpenEXR to report. Leaves the stream at its beginning.
void check_header(InputStream &in, const std::string &path);

// The number of samples per pixel with which a picture was rendered, if its header has `sparselens:samples` (dof-trace)
// or `cycles.LAYER.samples` (Blender's Cycles; the largest of its layers, because adaptive sampling may take fewer).
std::optional<double> render_samples(const Imf::Header &header);

void write_render_samples(Imf::Header &header, int samples);

} // namespace sparselens
