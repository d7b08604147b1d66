// Takes the picture of an LDI: takes a request as a user gives it, returns the picture and its header, and sends
// notices. It handles everything that a user could get wrong: the pixels and what lies beyond them, sub-pixels,
// proxies, holdouts, channels, the looks of the lens, what the method leaves out, and what the views did not see.
#pragma once

#include "../base/image.h"
#include "../base/kept.h"
#include "../dof/gather_picture.h"
#include "../dof/lens/lens_gather.h"
#include "../io/lens_file.h"
#include "../lens/lens_looks.h"
#include "../lens/photograph.h"
#include "../lens/thin_lens.h"
#include "../view/view.h"
#include "gather_windows.h"
#include "notices.h"

#include <ImfHeader.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <tuple>

namespace sparselens {

// The looks of the lens that takes a picture, and the picture's header that records them.

// Calls read_looks() (io/lens_file.h) and keeps the contents of the last files, because one of them may be a pipe.
class LooksReader {
public:
    LensFile read(const GivenLooks &given, std::optional<double> fstop);

private:
    // By the files and the f-number.
    Kept<std::tuple<std::string, std::string, std::optional<double>>, LensFile> said_{1};
};

// The given looks; where none are given, those of the camera. The camera then gets them, and the header names the lens.
// `lens` is that of the picture. Throws as resolve_looks() does.
LensLooks picture_looks(const LensFile &given, Camera &camera, Imf::Header &header, const ThinLens &lens,
                        const Windows &windows);

// Whether a method that treats the aperture as round would ignore some of these looks.
bool shape_aperture(const LookValues &looks);

struct GatherDevice; // chain/devices.h

// The picture, or false colours (dof/false_colour.h) that show how the LDI was interpreted.
enum class Show { picture, coc, focus, layers, tiles };

// Values that the request leaves out come from the LDI. For an LDI in memory, the path and the way to read it are
// ignored.
struct PictureRequest : LdiRequest {
    std::optional<Imath::V2i> focus_pixel = {}; // of the picture, EXR coordinates; empty: `lens` has it
    std::optional<PhotographBlur> blur = {};    // of a photograph, in place of a lens
    std::optional<double> grain = {};           // a factor of the photograph's own (dof/grain.h); empty: 1
    GivenLooks looks = {};
    WindowOptions windows = {};
    bool any_quality = true;     // none is asked for: a photograph is gathered at final quality
    PictureOptions picture = {}; // its holdout: as made by holdout_for(), if neither of the next two is set
    std::string holdout = {};    // a file
    const OpenedLdi *opened_holdout = nullptr;
    Show show = Show::picture;
    bool front_depth = false;       // also return the depth of the front samples
    std::string device = "cpu";     // as for choose_device() of gpu/device_list.h
    std::string shutter_curve = {}; // for take_moments(), as in io/moment_files.h; empty: a box
    double rolling_shutter = 1;     // for take_moments(): its duration (shutter/shutter_mean.h)
};

// The false colours of an LDI for that lens, for coc, focus and layers.
Image false_colours(Show show, const Ldi &ldi, const ThinLens &lens);

// Throws UsageError if a parameter is given that only another method has, or if the method cannot do what is requested.
void check_method(const PictureRequest &request,
                  const std::function<bool(const std::string &parameter)> &is_given);

// The progress, the notices and the devices of the work.
struct PictureWork {
    Progress &progress;
    Notify notify;
    GatherDevice *device = nullptr;   // finds the device of the request; null: the CPU works
    const TileWatch *watch = nullptr; // told about tiles, if they are pixels of the picture
    LooksReader *looks = nullptr;     // keeps the files that it reads
    int frame = 0;                    // the seed of the grain
};

struct TakenPicture {
    Image image;
    Image depth = {};        // if it was requested
    Imf::Header header = {}; // of the LDI, with the camera and the lens
    Camera camera = {};      // with its focus
    ThinLens lens = {};      // in pixels of the full-size picture
    LensTiles tiles = {};    // the choice of the lens gather; of several moments, in the middle one
    std::size_t moments = 1; // that the picture is the mean of
    std::size_t samples_read = 0, samples_invisible = 0; // of all moments, as in OpenedLdi
};

// The camera of the LDI with the lens of the request, focused on the pixel, if one is given. `depth_of` returns the
// depth in front of a pixel of the LDI, 0 for none. Throws UsageError if there is nothing to focus on.
Camera picture_camera(const PictureRequest &request, const OpenedLdi &in,
                      const std::function<float(const Imath::V2i &)> &depth_of);

// The lens of that camera, in pixels of the full-size picture.
ThinLens picture_lens(const PictureRequest &request, const OpenedLdi &in, const Camera &camera);

// Opens the holdout file of the request. Throws as open_ldi() and holdout_for() do.
Ldi open_holdout(const PictureRequest &request, const OpenedLdi &in);

// Throws Error, UsageError, and what `progress` throws.
TakenPicture take_picture(const OpenedLdi &in, const PictureRequest &request, const PictureWork &work);
// The same with less memory: the samples are used up.
TakenPicture take_picture(OpenedLdi &&in, const PictureRequest &request, const PictureWork &work);
// The same, if a proxy of the LDI was made before; `in` then needs no samples, but the focus must be known.
TakenPicture take_picture(const OpenedLdi &in, GatherWindows made_before, const PictureRequest &request,
                          const PictureWork &work);
// Takes the picture of a file. If the cache need not keep the file (`keep`), and the picture allows it, fewer samples
// are held while the file is read.
TakenPicture take_picture(LdiCache &cache, bool keep, const PictureRequest &request, const PictureWork &work);

// What take_picture() will return, before the work of gathering: the image has its windows and channels, and no values.
// For false colours it is taken with them. The samples are kept.
TakenPicture describe_picture(LdiCache &cache, const PictureRequest &request, const PictureWork &work);

} // namespace sparselens
