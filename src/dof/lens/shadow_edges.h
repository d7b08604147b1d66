// Finds where the four edges of a caster's shadow lie on a lamp's screen (lens/lamp_shadow.h).
#pragma once

#include "base/float4.h"
#include "dof/footprints/footprint.h"
#include "dof/lens/shadow_search.h"

#include <Imath/ImathBox.h>

namespace sparselens {

struct ShadowEdges {
    // The edges of the footprint, in its order: pixels, except the magnification.
    Float4 coc, magnified, from_lamp, at;

    // `across`, `corner`: as in ShadowCasters.
    ShadowEdges(const ShadowedLamp &lamp, float across, const Imath::V2f &corner, const Footprint &footprint);

    // Whether an edge is as blurred as the lamp and lies directly in front of it; then there is no shadow.
    bool as_blurred() const;
    // The shadow. If an edge is more blurred than the lamp, the shadow lies on its other side.
    Imath::Box2f shadow() const;
    // Whether the shadow on some member of a group may reach the group's screen. This must be the shadow on its middle
    // lamp.
    bool may_reach(const ShadowedLamp &group) const;
};

// Whether some of a shadow lies in a box of pixels.
bool reaches(const Imath::Box2f &shadow, const Imath::Box2i &box);

} // namespace sparselens
