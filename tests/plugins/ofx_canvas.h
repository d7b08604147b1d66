// Images of the host: their pixels, and EXR files of them.
#pragma once

#include "ofx_model.h"

#include <map>
#include <memory>
#include <string>

namespace ofx_host {

// The words of the command line by their names.
struct Words : std::map<std::string, std::string> {
    std::string text(const std::string &name, const std::string &otherwise) const;
    double number(const std::string &name, double otherwise) const;
    bool yes(const std::string &name) const { return text(name, "0") == "1"; }
};

// The pixels of an image: those of the scaled project, or of another region.
struct Canvas {
    std::string depth, components; // by the names of OpenFX
    double scale = 1, aspect = 1;
    int x1 = 0, y1 = 0, width = 0, height = 0, display_width = 0, display_height = 0;
    bool downwards = false, unpremultiplied = false;
};
Canvas canvas_of(const Words &words);

std::shared_ptr<Image> image_of(const Canvas &canvas);

// Reads R, G, B and A of a file, or Z alone as floats. The file has the size of the canvas.
std::shared_ptr<Image> read_image(const std::string &file, Canvas canvas, bool is_depth);

// Writes floats. Throws std::runtime_error, as read_image() does.
void write_image(Image &image, const Canvas &canvas, const std::string &file);

} // namespace ofx_host
