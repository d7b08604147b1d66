// The ways from an LDI to the lens picture, by name.
#pragma once

#include "../base/image.h"
#include "../base/progress.h"
#include "../deep/ldi.h"
#include "../lens/thin_lens.h"
#include "lens/lens_gather.h"

#include <span>

namespace sparselens {

// What can be asked of a method; each uses what concerns it.
struct GatherOptions {
    int layers = 8;         // selective: most layers a destination pixel keeps apart
    LensGatherOptions lens; // lens: quality, lens points
};

struct GatherMethod {
    const char *name;
    // The pixels of a window (EXR coordinates) within the LDI's data window, its channels, each by its
    // own coverage (deep/channel_alpha.h). The LDI is tidy, the lens has a radius above 0.
    Image (*gather)(const Ldi &, const ThinLens &, const Imath::Box2i &window, const GatherOptions &,
                    Progress &);
};

// The default first.
std::span<const GatherMethod> gather_methods();

} // namespace sparselens
