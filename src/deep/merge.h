// Several deep pictures of one camera: they are merged, or one holds out the other.
#pragma once

#include "ldi.h"

#include <string>
#include <vector>

namespace sparselens {

// Merges several layered pictures of one camera: each is an object, or a layer of the same samples.

// Whether `layer` has the samples of `ldi`, in the same order: where they lie beside Z, a layer need not say again.
bool same_samples(const Ldi &layer, const Ldi &ldi);

// Adds the channels of `layer`, which has the same samples as `ldi`. If a channel's name is taken, the channel becomes
// one of the layer `name`; if that name is taken too, the first channel is kept.
void add_layer(Ldi &ldi, Ldi layer, const std::string &name);

// All samples of the parts, ready for tidy(): pixel by pixel, the samples of the first part first. The display window
// is the first part's; the data window contains those of all parts. A channel that a part lacks is 0 in its samples,
// except for coverage: without A they are opaque, and without per-channel alpha AR, AG and AB equal A.
Ldi deep_merge(const std::vector<Ldi> &parts);

// A deep picture that holds out another one: it hides what lies behind its samples, and does not appear in the
// picture. It stays sharp, because light is held out at the pixel where it arrives.
class Holdout {
public:
    explicit Holdout(Ldi ldi); // tidy

    // The share of the light from depth z (scene units) that passes at pixel (x, y), EXR coordinates. A point hides
    // what lies behind it. A volume lets (1 - A)^t through, where t is the part of its extent in front of z
    // ("Interpreting OpenEXR Deep Pixels", F. Kainz, 2013). Depths that differ only by rounding are equal and do not
    // hide each other. Outside the data window all light passes.
    double passes(int x, int y, double z) const;

    // Data of passes(): for each sample of a pixel, front to back, its extent and the share of the light that it lets
    // through. append_parts() appends the parts of a pixel; parts_in() counts the parts in the pixels of a box.
    struct Part {
        float front, back, clear;
    };
    void append_parts(int x, int y, std::vector<Part> &parts) const;
    std::size_t parts_in(const Imath::Box2i &pixels) const;

private:
    Ldi ldi_;
    std::size_t alpha_;
};

// Flattens `ldi` with each sample multiplied by its share that passes the holdout.
Image flatten_held_out(const Ldi &ldi, const Holdout &holdout);

} // namespace sparselens
