// The picture that a lens takes from an LDI, whatever the method, the lens and the holdout: what dof-gather and the Python
// module do between the preparation of the LDI and the writing of the picture.
#pragma once

#include "merge_layers.h"
#include "methods.h"

namespace sparselens {

struct PictureOptions {
    const GatherMethod *method = &gather_methods().front();
    GatherOptions gather =
        {}; // its region and its holdout are set here, and what is beyond, where it is not given
    const Ldi *holdout =
        nullptr; // tidy, of the same display window; what it hides is not shown, nor is it itself
    bool holdout_defocused =
        false; // it is out of focus as the scene is; else it stays sharp, which the method lens alone knows
    // For the method lens: layers closer than that are merged first (merge_layers.h), pixels of CoC; 0: none. Beside a
    // sharp holdout none is, because it hides by depths that must not change.
    double layer_tolerance = layer_tolerance_px;
};

// The pixels `gathered` as the method takes it, of which `written` (within it) are the result. A lens of radius 0 gives
// the flattened LDI, unless its looks magnify the picture. The LDI is tidy.
Image gather_picture(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &gathered,
                     const Imath::Box2i &written, const PictureOptions &options, Progress &progress);

// The same with less memory: the samples of `ldi` are used up.
Image gather_picture(Ldi &&ldi, const ThinLens &lens, const Imath::Box2i &gathered,
                     const Imath::Box2i &written, const PictureOptions &options, Progress &progress);

// Whether layers are merged first. The merged layers then tell what goes on beyond the frame.
bool merges_layers(const ThinLens &lens, const PictureOptions &options);

// What the method lens makes of the samples of `rows` first, which lie alone: with a lens of radius 0 the flattened pixel,
// else merged layers where those of these channels are merged by rows; the picture of all rows is then that of a
// layer_tolerance of 0. Not for other methods and pictures with a holdout, and with radius 0 neither for those that a look magnifies
// nor for those with Cryptomattes.
bool can_reduce_first(const PictureOptions &options, const ThinLens &lens, bool magnifies,
                      std::span<const Channel> channels);
bool merges_by_rows(std::span<const Channel> channels);
Ldi reduced_first(Ldi rows, const ThinLens &lens, const PictureOptions &options);

} // namespace sparselens
