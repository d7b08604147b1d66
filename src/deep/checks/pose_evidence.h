// What the pixels of a view say of where it stood: where each of them lands in the centre view, it shows the same
// surface, hence the same colour, or a surface that is hidden from the centre; never one in front of what the centre
// view shows.
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
    bool shows_something(const Imath::V2i &p) const { return samples.is_single(index(p)); } // alone
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
    double contradiction = 0; // [0, 1], the mean over the pixels that tell
    std::size_t told = 0;     // how many there are: the centre view sees what they show
    std::size_t off_depth =
        0; // and of how many the depth tells against it; mirrors and glass mislead colours alone
};

class PoseEvidence {
public:
    // Chooses some ten thousand pixels of the view at most: those whose colour or depth differs from that of pixels
    // beside them, for a surface without texture looks the same from everywhere. Both views must outlive the evidence.
    // `focal_px` is the focal length in pixels.
    PoseEvidence(const PackedView &centre, const PackedView &view, double focal_px);

    // What they say if the view stands at `position`, and its optical axis meets the picture farther right and down by `axis`
    // display widths than its framing says. A pixel in front of what the centre view shows contradicts by 1,
    // one on the same surface by the relative difference of its colour from those that this surface has around there.
    // Off depth is what is in front, or nearer or farther than that surface is around there. One pixel in `every` is asked.
    PoseVerdict at(const Imath::V2d &position, const Imath::V2d &axis = {0, 0}, std::size_t every = 1) const;

    // How many pixels the nearest of them moves for each scene unit that the view is moved; 0 where there are none.
    double motion() const;
    std::size_t size() const { return pixels_.size(); }

private:
    struct Pixel {
        Imath::V2d place; // of its middle
        double z;
        Imath::V3d colour;
    };

    // Adds one that lands there, unless it may be hidden from the centre.
    void ask(const Imath::V2d &landed, const Pixel &pixel, PoseVerdict &verdict) const;

    PosedPicture centre_, view_;
    double focal_px_;
    std::vector<Pixel> pixels_;
};

} // namespace sparselens
