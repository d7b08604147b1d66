// Where the edges of a thing's shadow lie on a lamp's screen (lens/lamp_shadow.h), all four at once.
#pragma once

#include "base/float4.h"
#include "dof/footprints/footprint.h"
#include "dof/lens/shadow_search.h"

#include <Imath/ImathBox.h>

namespace sparselens {

struct ShadowEdges {
    // The edges of the footprint, in its order: pixels, except the magnification.
    Float4 coc, magnified, from_lamp, at;

    // `across`, `corner`: as ShadowCasters has them.
    ShadowEdges(const ShadowedLamp &lamp, float across, const Imath::V2f &corner, const Footprint &footprint);

    // Whether an edge is as blurred as the lamp, and right before it: it has no shadow.
    bool as_blurred() const;
    // Past an edge that is more blurred than the lamp it is the other way round.
    Imath::Box2f shadow() const;
    // Whether the shadow on some member of a group, whose middle lamp this is, may reach the group's screen.
    bool may_reach(const ShadowedLamp &group) const;
};

// Whether some of a shadow lies in a box of pixels.
bool reaches(const Imath::Box2f &shadow, const Imath::Box2i &box);

} // namespace sparselens
