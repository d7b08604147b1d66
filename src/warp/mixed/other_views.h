// The colour that other views show of a surface that something nearer hides or mixes in one view.
#pragma once

#include "deep/view_samples.h"
#include "view/view_mapping.h"

#include <array>
#include <optional>
#include <span>

namespace sparselens {

class OtherViews {
public:
    // `views` and `mappings` are those of all views, which have the same channels; they must outlive this. `own` is the
    // view that mixes the surfaces. `scale` is R F, pixels times scene units. It reads only the samples that the views had
    // at first: see ViewSamples::replace().
    OtherViews(std::span<const ViewSamples> views, std::span<const ViewMapping> mappings, std::size_t own,
               double scale);

    // Returns the colour of the surface at that perceptive depth, where the ray of the own view's pixel (from the
    // window's corner) meets it: the mean over the other flat views that show the surface there, opaque, and nothing
    // that is nearer by `apart` or more in that pixel or beside it. Returns nothing if there is no such view.
    std::optional<Imath::V3d> colour_behind(const Imath::V2i &pixel, double depth, double apart) const;

private:
    std::optional<std::size_t> pixel_of(std::size_t view, const Imath::V2d &in_centre, double depth,
                                        double apart) const;

    std::span<const ViewSamples> views_;
    std::span<const ViewMapping> mappings_;
    std::size_t own_;
    double scale_;
    std::array<std::size_t, 3> rgb_;
    std::size_t alpha_;
};

} // namespace sparselens
