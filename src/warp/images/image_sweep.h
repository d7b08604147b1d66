// At which depth does what a surface shows lie? A reflection moves between views as what it shows would, at the depth of
// its image, not as the mirror does. Within a block of pixels that show one surface, the views are compared at depths in
// front of and behind it, patch by patch, as in stereo matching by a plane sweep (R. Collins, "A space-sweep approach to
// true multi-image matching", 1996).
#pragma once

#include "base/parallel.h"
#include "warp/images/matched_view.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace sparselens {

// What the patch around a pixel says. Differences are mean squares over the patch, of R, G and B together, and over the
// three best of four views: one view may see something else there.
struct ImageMatch {
    bool surface = false; // it shows the surface of its block, and the views can be compared
    bool found = false; // one depth explains the views, and better by a clear margin than that of the surface
    float depth = 0;    // perceptive, pixels; below 0: rays meet behind the camera
    float own_depth = 0;  // of the surface
    float at_surface = 0; // the difference if the picture lay on the surface
};

class ImageSweep {
public:
    // The first view is the centre. `unit`: motion_unit() (kernels/photo_rules.h).
    ImageSweep(std::span<MatchedView> views, double unit) : views_(views), unit_(unit) {}

    std::span<const MatchedView> views() const { return views_; }
    double unit() const { return unit_; }

    // work(i) for i in [0, count), in parallel, some after the others: between these the views forget what was made of them if
    // it is much. So what follows in the picture should follow in count.
    template <typename Work>
    void go_through(std::size_t count, std::size_t at_once, const Work &work) const {
        for (std::size_t first = 0; first < count; first += at_once) {
            parallel_for(std::min(at_once, count - first), [&](std::size_t n) { work(first + n); });
            make_room();
        }
    }

    // Whether a block of the centre view has more depths to try than are tried one by one.
    bool has_many_depths(const Imath::Box2i &block) const;

    // Of the pixels of a block, at most 8 x 8, row by row. Where it has many depths, those near one of the guesses are tried, if
    // these are given.
    std::vector<ImageMatch> search(const Imath::Box2i &block,
                                   const std::optional<std::vector<float>> &guesses = {}) const;

    // By the pixels of a block, depths near those that depth_at(pixel) says for it and those around, which need not be the
    // same all over a patch; NaN where that is NaN.
    std::vector<float> refined(const Imath::Box2i &block,
                               const std::function<float(const Imath::V2i &)> &depth_at) const;

    // The difference of each pixel of a block from each rim view, view by view, if what it and those around show lies at the depths
    // that depth_at(pixel) says or, where that is NaN, at the middle one of those; NaN where too little can be compared.
    std::vector<float> differences(const Imath::Box2i &block,
                                   const std::function<float(const Imath::V2i &)> &depth_at) const;

private:
    void make_room() const;

    std::span<MatchedView> views_;
    double unit_;
};

} // namespace sparselens
