// A rendered picture with depth, and the camera that took it, as a file or a command line describes it. Every value
// may be unknown.
#pragma once

#include "../base/image.h"
#include "../base/subpixels.h"
#include "../looks/table.h"

#include <Imath/ImathMatrix.h>
#include <Imath/ImathVec.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace sparselens {

// How the framing of a view differs from that of the centre view. Their optical axes are parallel. By default both
// frame the scene alike, and the optical axis passes through the middle of the picture.
struct Framing {
    double forward = 0; // how far it stands in front of the centre view's camera, scene units
    double zoom = 1;    // its focal length over the centre view's, (0, inf)
    // Where its optical axis meets the picture: see Camera::principal_point.
    Imath::V2d principal_point{0, 0};

    bool operator==(const Framing &) const = default;
};

struct View {
    std::string name; // for messages
    Image image;      // R, G, B, A and further layers, premultiplied, without depth
    // The depth of each pixel: planar, measured from the camera of the centre view, in scene units, up to inf. A pixel
    // of depth 0 or less shows nothing, because it would lie behind that camera.
    std::vector<float> z;
    // The position of the camera relative to the centre view's: scene units, x right, y up, parallel axes.
    Imath::V2d position{0, 0};
    Framing framing = {};
};

// Camera space: +x right, +y up, +z forward. Matrices act on row vectors, as in OpenEXR.
struct Camera {
    std::optional<double> focal_length_mm; // (0, inf)
    std::optional<double> sensor_width_mm; // (0, inf), spans the display window
    std::optional<double> fstop;           // (0, inf]
    std::optional<double> lens_radius;     // of the aperture, scene units, [0, inf), as given by the user
    std::optional<double> focus_distance;  // scene units, (0, inf]
    std::optional<double> metres_per_unit; // (0, inf)
    LookValues looks;                      // only blades, their rotation and the squeeze
    // Width of the picture over the focal length, (0, inf). A field of view or a projection matrix gives it, also if
    // the focal length or the sensor width is unknown.
    std::optional<double> field;
    // Where the optical axis meets the picture, relative to the middle of the display window, in display widths, x
    // right, y down, pixels taken as square. If unknown: the middle.
    std::optional<Imath::V2d> principal_point;
    std::optional<Imath::M44d> world_to_camera;
    std::optional<Imath::M44d> world_to_ndc; // NDC: (0,0) and (1,1) are the display window's corners, y down
    std::optional<int> supersample; // sub-pixels, across and down, that become one pixel; [1, most_across]
    std::optional<PixelFilter> pixel_filter; // of the picture that they become
    std::vector<Imath::V2d> lens_points;     // in an LDI: positions of its views, scene units, x right, y up

    std::vector<std::string> found; // what was read, and from which attribute, for messages
    // Why a value is unknown although the file has attributes for it (they are invalid or contradict each other). The
    // key is the parameter that gives the value, e.g. "focal_length".
    std::map<std::string, std::string> unsure;
};

// Sets the field if focal length and sensor width are known. If only one of the two is known, sets the other one from
// the field, unless the file contradicts itself about it (Camera::unsure).
void complete_field(Camera &camera);

// The focal length in pixels of a picture that is `display_width` pixels wide. Empty if neither the field nor both of
// focal length and sensor width are known.
std::optional<double> focal_length_px(const Camera &camera, int display_width);

// How the framing of `view` differs from that of `centre`; `forward` is left to position_relative_to(). Values that are
// unknown for the view are those of the centre, and differences within the rounding of matrices to float are ignored.
// Throws Error (naming `what`) if its focal length is less than half or more than twice that of the centre: two such
// pictures are not views of one lens.
Framing framing_relative_to(const Camera &centre, const Camera &view, const std::string &what);

// The position of `view` in the camera space of `centre`, in scene units. Empty if either matrix is unknown. Throws
// Error (naming `what`) if the axes are not parallel.
std::optional<Imath::V3d> position_relative_to(const Camera &centre, const Camera &view,
                                               const std::string &what);

} // namespace sparselens
