// Takes a picture from an LDI, with any method, lens and holdout. dof-gather and the Python module call this between
// preparing the LDI and writing the picture.
#pragma once

#include "../base/image.h"
#include "../deep/ldi.h"
#include "merge_layers.h"
#include "methods.h"

namespace sparselens {

struct PictureOptions {
    const GatherMethod *method = &gather_methods().front();
    // gather_picture() sets its region and its holdout, and `beyond` if that is not given.
    GatherOptions gather = {};
    // A deep picture with the same display window. It hides what lies behind it, and does not appear in the picture.
    const Ldi *holdout = nullptr;
    // The holdout is out of focus like the scene; else it stays sharp, which only the method lens supports.
    bool holdout_defocused = false;
    // For the method lens: layers closer than this are merged first (merge_layers.h), pixels of CoC; 0: none. Beside a
    // sharp holdout no layers are merged, because it hides by depths that must not change.
    double layer_tolerance = layer_tolerance_px;
};

// Gathers the pixels `gathered` and returns the pixels `written`, which lie within them. A lens of radius 0 gives the
// flattened LDI, unless its looks magnify the picture.
Image gather_picture(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &gathered,
                     const Imath::Box2i &written, const PictureOptions &options, Progress &progress);

// The same with less memory: uses up the samples of `ldi`.
Image gather_picture(Ldi &&ldi, const ThinLens &lens, const Imath::Box2i &gathered,
                     const Imath::Box2i &written, const PictureOptions &options, Progress &progress);

// Whether layers are merged first. What continues beyond the frame is then found from the merged layers.
bool merges_layers(const ThinLens &lens, const PictureOptions &options);

// Rows can be reduced on their own, before the picture is gathered from all of them with a layer_tolerance of 0.
// reduced_first() returns the reduced rows: with a lens of radius 0, one flattened sample per pixel; else the merged
// layers, if merges_by_rows() says that LDIs with these channels can be merged by rows. can_reduce_first() says no for
// other methods than lens, for pictures with a holdout, and for pictures that a look magnifies (`magnifies`); with
// radius 0, also for pictures with Cryptomattes.
bool can_reduce_first(const PictureOptions &options, const ThinLens &lens, bool magnifies,
                      std::span<const Channel> channels);
bool merges_by_rows(std::span<const Channel> channels);
Ldi reduced_first(Ldi rows, const ThinLens &lens, const PictureOptions &options);

// A holdout that is out of focus like the scene. Its samples hide what is behind them at every lens point, but they are
// not shown and leave no coverage of their own.
//
// They are merged into the LDI without colour. Extra channels carry their coverage, so that it can be subtracted again
// after the gather, by any method.

// Returns the LDI to gather.
Ldi with_holdout(const Ldi &ldi, const Ldi &holdout);

// Removes the coverage of the holdout, and the extra channels, from a picture gathered from that LDI.
Image without_holdout(Image picture);

} // namespace sparselens
