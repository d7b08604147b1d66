// The ways from an LDI to the lens picture, by name.
#pragma once

#include "base/image.h"
#include "base/progress.h"
#include "ldi/ldi.h"
#include "lens/thin_lens.h"

#include <span>

namespace sparselens {

// What can be asked of a method; each uses what concerns it.
struct GatherOptions {
    int layers = 8; // selective: most layers a destination pixel keeps apart
};

struct GatherMethod {
    const char *name;
    // The LDI is tidy, the lens has a radius above 0. Windows and channels are the LDI's.
    Image (*gather)(const Ldi &, const ThinLens &, const GatherOptions &, Progress &);
};

// The default first.
std::span<const GatherMethod> gather_methods();

} // namespace sparselens
