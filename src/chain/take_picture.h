// Takes the picture of an LDI: from a request, which is what a user may say, to the picture, its header and what is to be said of it.
// All that a user could get wrong is seen to here: the pixels and what lies beyond them, sub-pixels, proxies, holdouts, channels, the
// looks of the lens, what the method leaves out, what the views did not see.
#pragma once

#include "../dof/gather_picture.h"
#include "../dof/lens/lens_tiles.h"
#include "gather_windows.h"
#include "ldi_cache.h"
#include "notices.h"
#include "picture_looks.h"

#include <functional>
#include <optional>
#include <string>

namespace sparselens {

struct GatherDevice; // chain/devices.h

// The picture, or false colours (dof/false_colour.h) of what was understood.
enum class Show { picture, coc, focus, layers, tiles };

// The LDI says whatever the request leaves out. For an LDI in memory, its path and the way to read it do not matter.
struct PictureRequest : LdiRequest {
    std::optional<Imath::V2i> focus_pixel = {}; // of the picture, EXR coordinates; else `lens` says the focus
    GivenLooks looks = {};
    WindowOptions windows = {};
    PictureOptions picture = {}; // its holdout: as holdout_for() makes it, if it is not one of the next two
    std::string holdout = {};    // a file
    const OpenedLdi *opened_holdout = nullptr;
    Show show = Show::picture;
    bool front_depth = false;   // also the depth of the front samples
    std::string device = "cpu"; // as choose_device() of gpu/device_list.h has it
};

// The false colours of an LDI for that lens: of coc, focus and layers.
Image false_colours(Show show, const Ldi &ldi, const ThinLens &lens);

// Throws UsageError where a parameter is given that another method alone has, and where the method cannot do what is asked for.
void check_method(const PictureRequest &request,
                  const std::function<bool(const std::string &parameter)> &is_given);

// The progress, the notices and the devices of the work.
struct PictureWork {
    Progress &progress;
    Tell tell;
    GatherDevice *device = nullptr;   // which finds the device of the request; none: the CPU works
    const TileWatch *watch = nullptr; // told of tiles, if they are pixels of the picture
    LooksReader *looks = nullptr;     // keeps what it reads
};

struct TakenPicture {
    Image image;
    Image depth = {};        // if it was asked for
    Imf::Header header = {}; // of the LDI, with the camera and the lens
    Camera camera = {};      // with its focus
    ThinLens lens = {};      // in pixels of the full-size picture
    LensTiles tiles = {};    // what the lens gather chose
};

// The camera of the LDI with the lens of the request, focused on the pixel, if one is given; `depth_of` gives the depth in front of a
// pixel of the LDI, 0 for none. UsageError: there is nothing to focus on.
Camera picture_camera(const PictureRequest &request, const OpenedLdi &in,
                      const std::function<float(const Imath::V2i &)> &depth_of);

// The lens of that camera, in pixels of the full-size picture.
ThinLens picture_lens(const PictureRequest &request, const OpenedLdi &in, const Camera &camera);

// The holdout of the request's file. Throws as open_ldi() and holdout_for() do.
Ldi open_holdout(const PictureRequest &request, const OpenedLdi &in);

// Throws Error, UsageError, and what `progress` throws.
TakenPicture take_picture(const OpenedLdi &in, const PictureRequest &request, const PictureWork &work);
// The same with less memory: the samples are used up.
TakenPicture take_picture(OpenedLdi &&in, const PictureRequest &request, const PictureWork &work);
// The same, if a proxy of the LDI was made before; `in` then needs no samples, but the focus must be known.
TakenPicture take_picture(const OpenedLdi &in, GatherWindows made_before, const PictureRequest &request,
                          const PictureWork &work);
// Takes the picture of a file. Where the cache need not keep it for the next picture, fewer samples are held while it is read, if the picture allows.
TakenPicture take_picture(LdiCache &cache, bool keep, const PictureRequest &request, const PictureWork &work);

} // namespace sparselens
