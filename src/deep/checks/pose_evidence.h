// What the pixels of a view tell about where it stood. In the centre view, each of them must land on the same surface,
// and so the same colour, or on a nearer surface that hides it from the centre. It never lies in front of what the
// centre view shows.
#pragma once

#include "deep/packed_view.h"

#include <array>
#include <vector>

namespace sparselens {

// A view with its channels found.
struct PosedPicture {
    explicit PosedPicture(const PackedView &picture)
        : view(picture), samples(picture.samples), rgb(find_rgb(samples.channels)) {}

    std::size_t index(const Imath::V2i &p) const { return samples.windows.index(p.x, p.y); }
    bool shows_something(const Imath::V2i &p) const { return samples.is_single(index(p)); } // a single sample
    double depth(const Imath::V2i &p) const { return samples.z(index(p)); }
    Imath::V3d colour(const Imath::V2i &p) const {
        const auto value = [&](std::size_t k) { return k == npos ? 0 : double(samples.value(k, index(p))); };
        return {value(rgb[0]), value(rgb[1]), value(rgb[2])};
    }

    const PackedView &view;
    const ViewSamples &samples;
    std::array<std::size_t, 3> rgb;
};

struct PoseVerdict {
    double contradiction = 0;  // [0, 1], the mean over the pixels that tell
    std::size_t told = 0;      // the number of these pixels: the centre view sees what they show
    std::size_t off_depth = 0; // the number whose depth contradicts; mirrors and glass mislead colours alone
};

class PoseEvidence {
public:
    // Chooses at most some ten thousand pixels of the view, whose colour or depth differs from that of neighbouring
    // pixels, because a surface without texture looks the same from everywhere. Both views must outlive the evidence.
    // `focal_px` is the focal length in pixels.
    PoseEvidence(const PackedView &centre, const PackedView &view, double focal_px);

    // The verdict if the view stands at `position`, and its optical axis meets the picture farther right and down by
    // `axis` display widths than its framing says. A pixel in front of what the centre view shows contradicts by 1; a
    // pixel on the same surface contradicts by the relative difference between its colour and the colours of this
    // surface around it. Its depth contradicts if it is in front, or nearer or farther than that surface is there. One
    // pixel in `every` is tested.
    PoseVerdict at(const Imath::V2d &position, const Imath::V2d &axis = {0, 0}, std::size_t every = 1) const;

    // How many pixels the nearest chosen pixel moves per scene unit of the view's motion; 0 if there are none.
    double motion() const;
    std::size_t size() const { return pixels_.size(); }

private:
    struct Pixel {
        Imath::V2d place; // of the pixel's middle
        double z;
        Imath::V3d colour;
    };

    // Adds a pixel that lands at `landed` to the verdict, unless it may be hidden from the centre.
    void ask(const Imath::V2d &landed, const Pixel &pixel, PoseVerdict &verdict) const;

    PosedPicture centre_, view_;
    double focal_px_;
    std::vector<Pixel> pixels_;
};

} // namespace sparselens
