#include "deep/checks/pose_evidence.h"

#include "view/flat_pixels.h"
#include "view/view_mapping.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

namespace {

constexpr double samples_a_side = 128; // of the view's pixels, enough to tell
constexpr int beside = 2;              // pixels
constexpr double contrast = 0.1;       // relative difference of colour
constexpr double jump = 1.05;          // ratio of depths
constexpr double same_depth = 1.04;    // ratio; nearer samples are in front
constexpr double rounding = 1e-3;      // of depths, relative: the precision of half

bool holds(const Imath::Box2i &data, const Imath::V2d &p) {
    return p.x >= data.min.x && p.x < data.max.x + 1.0 && p.y >= data.min.y && p.y < data.max.y + 1.0;
}

// Whether the pixel differs from the pixel to the right or the pixel below.
bool stands_out(const PosedPicture &picture, const Imath::V2i &p) {
    for (const Imath::V2i &q : {p + Imath::V2i(beside, 0), p + Imath::V2i(0, beside)}) {
        if (!picture.samples.windows.data.intersects(q) || !picture.shows_something(q)) continue;
        const double z = picture.depth(p), other = picture.depth(q);
        if (z > jump * other || other > jump * z) return true;
        if (relative_difference(picture.colour(p), picture.colour(q)) > contrast) return true;
    }
    return false;
}

} // namespace

PoseEvidence::PoseEvidence(const PackedView &centre, const PackedView &view, double focal_px)
    : centre_(centre), view_(view), focal_px_(focal_px) {
    const Windows &w = view.samples.windows;
    const Imath::V2i step(int(std::ceil(w.width() / samples_a_side)),
                          int(std::ceil(w.height() / samples_a_side)));
    for (int y = w.data.min.y; y <= w.data.max.y; y += step.y)
        for (int x = w.data.min.x; x <= w.data.max.x; x += step.x) {
            const Imath::V2i p(x, y);
            if (view_.shows_something(p) && stands_out(view_, p))
                pixels_.push_back({Imath::V2d(p) + Imath::V2d(0.5), view_.depth(p), view_.colour(p)});
        }
}

PoseVerdict PoseEvidence::at(const Imath::V2d &position, const Imath::V2d &axis, std::size_t every) const {
    Framing framing = view_.view.framing;
    framing.principal_point += axis;
    const ViewMapping mapping(position, focal_px_, view_.samples.windows, framing,
                              centre_.view.framing.principal_point);
    PoseVerdict verdict;
    for (std::size_t i = 0; i < pixels_.size(); i += every) {
        const Pixel &pixel = pixels_[i];
        const Imath::V2d landed =
            mapping.at_infinity(pixel.place) + mapping.parallax(pixel.place) * (1 / pixel.z);
        if (!holds(centre_.samples.windows.data, landed)) continue;
        ask(landed, pixel, verdict);
    }
    if (verdict.told > 0) verdict.contradiction /= double(verdict.told);
    return verdict;
}

// The landing point is known to a pixel: any of the four pixels around it may show the same surface, or one that hides
// it.
void PoseEvidence::ask(const Imath::V2d &landed, const Pixel &pixel, PoseVerdict &verdict) const {
    Imath::V3d least(0), most(0);
    double nearest = pixel.z, farthest = pixel.z;
    bool seen = false, hidden = false;
    for (const double dx : {-0.5, 0.5})
        for (const double dy : {-0.5, 0.5}) {
            const Imath::V2i p(int(std::floor(landed.x + dx)), int(std::floor(landed.y + dy)));
            if (!centre_.samples.windows.data.intersects(p) || !centre_.shows_something(p)) continue;
            const double z = centre_.depth(p);
            hidden = hidden || pixel.z > same_depth * z;
            if (pixel.z > same_depth * z || z > same_depth * pixel.z) continue;
            const Imath::V3d there = centre_.colour(p);
            for (int k = 0; k < 3; ++k) {
                least[k] = seen ? std::min(least[k], there[k]) : there[k];
                most[k] = seen ? std::max(most[k], there[k]) : there[k];
            }
            nearest = seen ? std::min(nearest, z) : z;
            farthest = seen ? std::max(farthest, z) : z;
            seen = true;
        }
    if (!seen && hidden) return;
    ++verdict.told;
    verdict.off_depth += !seen || pixel.z < nearest * (1 - rounding) || pixel.z > farthest * (1 + rounding);
    Imath::V3d closest;
    for (int k = 0; k < 3; ++k) closest[k] = std::clamp(pixel.colour[k], least[k], most[k]);
    verdict.contradiction += seen ? relative_difference(closest, pixel.colour) : 1;
}

double PoseEvidence::motion() const {
    const auto nearest = std::ranges::min_element(pixels_, {}, &Pixel::z);
    return nearest == pixels_.end() ? 0 : focal_px_ / nearest->z;
}

} // namespace sparselens
