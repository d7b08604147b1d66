// Finds the depth of what a surface shows. A reflection moves between views like the thing that it shows, at the depth
// of its image, not like the mirror. Within a block of pixels that show one surface, the views are compared at depths
// in front of it and behind it, patch by patch, as in stereo matching by a plane sweep (R. Collins, "A space-sweep
// approach to true multi-image matching", 1996).
#pragma once

#include "base/parallel.h"
#include "warp/images/matched_view.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace sparselens {

// The result for the patch around a pixel. Differences are mean squares over the patch, of R, G and B together, and
// over the three best of four views, because one view may see something else there.
struct ImageMatch {
    bool surface = false; // it shows the surface of its block, and the views can be compared
    // one depth explains the views, and better by a clear margin than the surface's depth
    bool found = false;
    float depth = 0;      // perceptive, pixels; below 0: rays meet behind the camera
    float own_depth = 0;  // of the surface
    float at_surface = 0; // the difference if the picture lay on the surface
};

class ImageSweep {
public:
    // The first view is the centre. `unit`: motion_unit() (kernels/photo_rules.h).
    ImageSweep(std::span<MatchedView> views, double unit) : views_(views), unit_(unit) {}

    std::span<const MatchedView> views() const { return views_; }
    double unit() const { return unit_; }

    // Calls work(i) for i in [0, count), `at_once` of them in parallel. In between, the views free what was made of
    // them if it is much. So work on neighbouring parts of the picture should have neighbouring numbers.
    template <typename Work>
    void go_through(std::size_t count, std::size_t at_once, const Work &work) const {
        for (std::size_t first = 0; first < count; first += at_once) {
            parallel_for(std::min(at_once, count - first), [&](std::size_t n) { work(first + n); });
            make_room();
        }
    }

    // Whether a block of the centre view has more depths to try than are tried one by one.
    bool has_many_depths(const Imath::Box2i &block) const;

    // Searches the pixels of a block of at most 8 x 8, row by row. If the block has many depths and guesses are given,
    // only depths near a guess are tried.
    std::vector<ImageMatch> search(const Imath::Box2i &block,
                                   const std::optional<std::vector<float>> &guesses = {}) const;

    // Returns refined depths of the pixels of a block, near the depths that depth_at(pixel) gives for them and the
    // pixels around, which may differ within a patch; NaN where depth_at() is NaN.
    std::vector<float> refined(const Imath::Box2i &block,
                               const std::function<float(const Imath::V2i &)> &depth_at) const;

    // Returns the difference of each pixel of a block from each rim view, view by view, if what it and the pixels
    // around show lies at the depths that depth_at(pixel) gives, or at the median of these where that is NaN. NaN where
    // too little can be compared.
    std::vector<float> differences(const Imath::Box2i &block,
                                   const std::function<float(const Imath::V2i &)> &depth_at) const;

private:
    void make_room() const;

    std::span<MatchedView> views_;
    double unit_;
};

} // namespace sparselens
