// What a lens point sees of a pixel, slowly: lens_gather_reference.h says by which rules. In long double, and with
// every answer that rounding may give.
#pragma once

#include "deep/holdout.h"
#include "deep/ldi.h"
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
    const Filler *filler = nullptr; // where it is one
    long double image_coc = coc;    // of the image that an opaque sample shows, where it is one of a mirror
    const Placed *shown = nullptr;  // where it is a solid: the sample that shows there
    bool is_image() const { return image_coc != coc; }
    const Placed &shows() const { return shown ? *shown : *this; }
};

// Everything there is to be seen, front to back.
struct Scene {
    const ThinLens &lens;
    std::vector<Placed> samples, fillers,
        solids; // a solid's z is that from which on it hides what is farther
    std::vector<std::array<std::size_t, 3>> facets; // between samples
};

// All samples, and inside the window the backgrounds behind what is not opaque; the facets between them; and the fillers.
Scene place_scene(const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window,
                  std::span<const Filler> fillers);

struct Pixel {
    int x, y;
    long double extent; // the largest coordinate there is: a float knows a place to some 1e-7 of it
    const Holdout *holdout;
};

// The part of a scene that some lens point may see of a pixel or of those beside it, if none lies farther from the middle of the lens in x or
// in y: what else there is only takes time.
Scene near(const Scene &scene, const Pixel &pixel, long double widest);

// How far a place is from the edge of what is looked at, inside; and how far rounding may move it.
struct Margin {
    long double inside, unclear;
    bool outside() const { return inside < -unclear; }
    bool sure() const { return inside > unclear; }
};

// A sample that a lens point sees, or sees by one way of rounding.
struct Met {
    const Placed *sample;
    bool seen, sure;
    long double passes; // of its light, the holdout
};

// One way in which a lens point may see a pixel: what it meets, front to back; and whether it is the way it does.
struct Way {
    std::vector<Met> met;
    bool is;
};

// All of which one is the way.
std::vector<Way> ways_to_see(const Scene &scene, const LensSample &point, const Pixel &pixel);

long double alpha_of(const Ldi &ldi, std::uint64_t sample);

} // namespace sparselens
