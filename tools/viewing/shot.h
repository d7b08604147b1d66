// The LDI that is looked at: loaded once, gathered as often as somebody asks.
#pragma once

#include "gpu/gather/gather_device.h"
#include "harness/tool.h"
#include "io/display/colour.h"
#include "io/display/shown_picture.h"
#include "io/gather_windows.h"
#include "loading/chosen_device.h"
#include "loading/ldi_cache.h"
#include "options/gather_options.h"

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace sparselens {

// A picture through a lens: linear R, G, B and A.
struct TakenPicture {
    Image image;
    Camera camera; // with its focus
    ThinLens lens; // for pixels of the full-size picture
    std::vector<std::string> warnings = {};
};

class Shot {
public:
    // Reads the file. Throws as dof-gather does.
    Shot(const GatherCommand &options, const ToolContext &tool);

    const OpenedLdi &in() const { return cache_.last(); }
    int across() const { return across_; } // sub-pixels of the LDI that become one pixel

    // What dof-gather would write; by one thread at a time. Throws as that does, and what `progress` throws.
    TakenPicture taken(const GatherCommand &options, const ToolContext &tool, Progress &progress);

    // The camera and the lens of such a picture; by any number of threads.
    Camera camera(const GatherCommand &options) const;
    ThinLens lens(const Camera &camera) const; // for pixels of the picture

    // As PNG shows linear colours of the file's space, after `exposure` stops.
    ShownPixels displayed(Image image, double exposure) const;

private:
    const GatherWindows &small_windows(const WindowOptions &options, int proxy);

    LdiCache cache_;
    ChosenDevice<TileDevice> device_;
    ColourTransform to_display_;
    int across_ = 1;
    std::map<int, GatherWindows> small_; // by their proxy, the last few
};

} // namespace sparselens
