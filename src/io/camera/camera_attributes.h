// The names that renderers and compositors give to camera attributes in EXR headers, in one table, and how their values
// are read. Names are matched regardless of case, and with or without the prefixes "exr/", "nuke/", "input/" and
// "openexr:", which Nuke and OpenImageIO add or remove.
//
// Sources: OpenEXR's StandardAttributes page and ImfStandardAttributes.h; OpenImageIO's table in exrinput.cpp; headers
// of V-Ray files on the web; Maxon's page "EXR Metadata" of Redshift; Unreal's MoviePipelineImagePassBase.cpp; the
// scripts with which compositors make Nuke cameras from such files.
#pragma once

#include <Imath/ImathMatrix.h>
#include <Imath/ImathVec.h>
#include <ImfHeader.h>

#include <optional>
#include <string>
#include <vector>

namespace sparselens {

// Attributes without a standard name that are not quantities.
inline constexpr const char *lens_points_name = "sparselens:lensPoints"; // text "x,y x,y ...", scene units
inline constexpr const char *picture_window_name = "sparselens:dataWindow";
inline constexpr const char *supersample_name = "ldi.supersample";  // int
inline constexpr const char *pixel_filter_name = "ldi.pixelFilter"; // text, as pixel_filter_of() reads it

enum class Quantity {
    focal_length, // mm
    sensor_width, // mm, spans the display window
    film_back,    // mm, width of the camera's film back; the picture may show a part of it
    field,        // width of the picture over the focal length
    fstop,        // f-number
    focus_metres, // distance
    focus_units,  // distance
    metres_per_unit,
    blades,
    blade_rotation, // degrees
    squeeze,
};

// A number that the header holds under a name of the table.
struct NamedNumber {
    Quantity quantity;
    std::string name; // as the file spells it
    double value;     // in the unit of the quantity; NaN if it is not a number
    bool exact;       // false: only a hint, used if there is nothing better (a nominal focal length)
};

struct NamedMatrix {
    enum class Kind { world_to_camera, world_to_ndc } kind;
    std::string name;
    std::optional<Imath::M44d> matrix; // acts on row vectors; empty: not finite, or singular
    // world_to_camera: true if its axes are known to be ours (+x right, +y up, +z forward), false if z may look
    // backward. world_to_ndc: true if it is known to be the clip space [-1,1], false if it may be either.
    bool certain;
};

struct CameraAttributes {
    std::vector<NamedNumber> numbers; // in the table's order
    std::vector<NamedMatrix> matrices;
    // From screenWindowCenter and screenWindowWidth, see Camera. Empty if they have their default values, because
    // programs without a camera write these.
    std::optional<Imath::V2d> principal_point;
    std::string
        no_perspective; // the attribute that states another projection, and its value; otherwise empty
    bool ours = false;  // written by this project, so attributes of other programs are not listed
};

// All camera attributes of the header.
CameraAttributes find_camera_attributes(const Imf::Header &header);

} // namespace sparselens
