// Pictures asked of dof-view --pipe, which begins with the first question. Throws std::runtime_error with the reason.
#pragma once

#include "host_image.h"
#include "place.h"

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace sparselens_ofx {

// A flat picture, as it is handed to the gatherer: floats, row by row from the top.
struct FlatPicture {
    Box display, data; // of the pixels
    double pixel_aspect = 1;
    bool shown = false; // its colours are for a screen
    std::vector<std::string> channels = {};
    std::vector<float> pixels = {};
};

struct Question {
    std::string file = {}; // or a flat picture
    std::shared_ptr<const FlatPicture> flat = {};
    std::map<std::string, std::string> settings = {};
    int frame = 0;
    bool shown = false; // the answer's colours are for a screen
};

// Windows and channels of the picture.
struct Header {
    Box display, data;
    std::vector<std::string> channels;
};
Header ask_header(const Question &question);

// The pixels of the box, which must lie within the data window: row by row from the top, each with R, G, B and A. A
// picture without A is opaque.
std::vector<float> ask_pixels(const Question &question, const Header &header, const Box &box);

// Ends the gatherer. Nobody may ask at the same time.
void stop_asking();

} // namespace sparselens_ofx
