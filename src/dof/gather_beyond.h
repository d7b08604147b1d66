// A gather of an LDI in which what leaves the frame goes on beyond it.
#pragma once

#include "dof/lens/beyond/beyond_frame.h"
#include "dof/methods.h"

#include <utility>

namespace sparselens {

// gather(ldi, options) of it; of `ldi` itself where nothing is known beyond the frame. `ldi` is an Ldi&&, if it may be used up,
// or a const Ldi&.
template <typename AnyLdi, typename Gather>
Image gather_beyond(AnyLdi &&ldi, const ThinLens &lens, const Imath::Box2i &window,
                    const GatherOptions &options, const Gather &gather) {
    if (!options.beyond) return gather(ldi, options.lens);
    LensGatherOptions by = options.lens;
    const BeyondFrame all =
        go_on_beyond(std::forward<AnyLdi>(ldi), lens, by.looks, options.beyond->frame,
                     by.known.value_or(window), options.beyond->reach, by.across, options.views_radius);
    by.known = all.known;
    by.unseen = all.unseen;
    by.seen = options.beyond->frame;
    return gather(all.ldi, by);
}

} // namespace sparselens
