// Gathers an LDI after continuing beyond the frame what leaves it.
#pragma once

#include "dof/lens/beyond/frame_extension.h"
#include "dof/methods.h"

#include <utility>

namespace sparselens {

// Returns gather(ldi, options) of the continued LDI, or of `ldi` itself if options.beyond is not set. Pass an Ldi&& if
// `ldi` may be used up, else a const Ldi&.
template <typename AnyLdi, typename Gather>
Image gather_beyond(AnyLdi &&ldi, const ThinLens &lens, const Imath::Box2i &window,
                    const GatherOptions &options, const Gather &gather) {
    if (!options.beyond) return gather(ldi, options.lens);
    LensGatherOptions by = options.lens;
    const FrameExtension all = extend_beyond_frame(std::forward<AnyLdi>(ldi), lens, by.looks,
                                                   options.beyond->frame, by.known.value_or(window),
                                                   options.beyond->reach, by.across, options.views_radius);
    by.known = all.known;
    by.unseen = all.unseen;
    by.seen = options.beyond->frame;
    return gather(all.ldi, by);
}

} // namespace sparselens
