// The main headers, from views to an LDI and to a picture. These rules hold for all headers; a header states its
// exceptions:
//
// Units. Depth is planar, in scene units, in (0, inf]; inf is the sky. Positions of cameras are in scene units: x
// right, y up, z forward. Places in a picture are EXR coordinates: pixels, x right, y down; a window includes its last
// pixel. Lengths in a picture, such as the radius of a circle of confusion, are in pixels.
// Samples. LDIs are tidy, as open_ldi() and warp() return them (deep/tidy.h): the samples of a pixel are sorted by
// depth and do not overlap. Colours are premultiplied and scene-linear.
// Errors. Functions throw UsageError if an argument is missing or impossible, and Error if a file cannot be read or
// written, or memory runs out (base/error.h). Messages name the file, channel or parameter.
// Threads. Functions use all threads that oneTBB gives them; their number never changes a result. Several may
// run at the same time if they share no modifiable argument. Only io/, and chain/ through it, reads and writes files.
#pragma once

#include "chain/gather_windows.h"
#include "chain/take_picture.h"
#include "deep/cluster.h"
#include "deep/tidy.h"
#include "dof/gather_picture.h"
#include "io/camera/camera_header.h"
#include "io/exr/exr_deep.h"
#include "io/exr/exr_flat.h"
#include "io/open_ldi.h"
#include "io/open_view.h"
#include "lens/thin_lens.h"
#include "view/lens_views.h"
#include "view/resolve_lens.h"
#include "warp/warp.h"
