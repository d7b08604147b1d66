// What a lens point sees of a pixel, slowly, by the rules in lens_gather_reference.h. In long double, with every answer
// that rounding may give.
#pragma once

#include "deep/ldi.h"
#include "deep/merge.h"
#include "dof/lens/fillers.h"
#include "lens/lens_samples.h"
#include "lens/thin_lens.h"

#include <array>
#include <span>
#include <vector>

namespace sparselens {

struct Placed {
    long double x, y, coc, z, alpha; // EXR coordinates, pixels, scene units
    std::uint64_t source;
    bool background;
    const Filler *filler = nullptr; // if it is a filler
    long double image_coc = coc;    // of its image, if the sample is an opaque one of a mirror
    const Placed *shown = nullptr;  // if it is a solid: the sample that it shows
    bool is_image() const { return image_coc != coc; }
    const Placed &shows() const { return shown ? *shown : *this; }
};

// All visible things, front to back.
struct Scene {
    const ThinLens &lens;
    std::vector<Placed> samples, fillers,
        solids;                                     // a solid's z is the depth beyond which it hides things
    std::vector<std::array<std::size_t, 3>> facets; // between samples
};

// All samples, and inside the window the backgrounds behind pixels that are not opaque; the facets between samples; and
// the fillers.
Scene place_scene(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window,
                  std::span<const Filler> fillers);

// The whole numbers in which the gather counts where samples are seen (lens_gather_reference.h).
struct Rounding {
    long double extent; // the largest coordinate in use; a float resolves positions to about 1e-7 of it
    long double unit,
        lens_unit; // units in a pixel; CoCs are multiplied by the other, and lens points divided
    // pixels: opaque samples may be seen in either order if their disparities, or the CoCs of images, differ by less
    long double depth, image;
};

struct Pixel {
    int x, y;
    Imath::V2i middle; // of its tile, from which places are counted
    Rounding rounding;
    const Holdout *holdout;
};

// The part of a scene that lens points may see in a pixel or its neighbours, if no lens point is farther than `widest`
// from the middle of the lens in x or in y. Leaving out the rest saves time.
Scene near(const Scene &scene, const Pixel &pixel, long double widest);

// How far a point is inside an edge, and how far rounding may move it.
struct Margin {
    long double inside, unclear;
    bool outside() const { return inside < -unclear; }
    bool sure() const { return inside > unclear; }
};

// A sample that a lens point sees, or may see through rounding.
struct Met {
    const Placed *sample;
    bool seen, sure;
    long double passes; // the share of its light that the holdout passes
};

// One way in which a lens point may see a pixel: the samples met, front to back, and whether this is the way without
// rounding.
struct Way {
    std::vector<Met> met;
    bool is;
};

// All ways; exactly one of them `is`.
std::vector<Way> ways_to_see(const Scene &scene, const LensSample &point, const Pixel &pixel);

long double alpha_of(const Ldi &ldi, std::uint64_t sample);

} // namespace sparselens
