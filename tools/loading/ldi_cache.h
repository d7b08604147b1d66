// The last LDI read: a pull of focus over one file reads it once.
#pragma once

#include "harness/tool.h"
#include "loading/pictures.h"
#include "options/colour_options.h"
#include "options/lens_options.h"

#include <ImfHeader.h>

#include <memory>
#include <string>
#include <vector>

namespace sparselens {

// What a frame works on: the file's samples, its own copy of header and camera.
struct InputLdi {
    std::string name; // of the file, for messages
    const Ldi &ldi;   // tidy; the cache's
    Imf::Header header;
    Camera camera;                                     // of the header, with the options over it
    bool read_now;                                     // not left from an earlier frame
    std::size_t invisible;                             // see LoadedLdi
    const std::vector<std::string> &channels_left_out; // the cache's
};

class LdiCache {
public:
    // load_ldi(), to_scene_linear() and keep_channels() where the last file was another or was read otherwise; warns
    // of bad values then. What was returned before is gone.
    InputLdi load(const std::string &path, const std::string &channels, const LensOptions &lens,
                  const DepthOptions &depth, const ColourOptions &colour, const ToolContext &tool);

private:
    struct Entry;
    std::shared_ptr<const Entry> last_;
};

} // namespace sparselens
