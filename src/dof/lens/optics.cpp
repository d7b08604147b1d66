#include "dof/lens/optics.h"

#include "base/parallel.h"

#include <algorithm>
#include <functional>

namespace sparselens {

Optics::Optics(const Ldi &ldi, const ThinLens &lens, const LensLooks &looks_, double coc_)
    : looks(looks_), coc(coc_), corner(ldi.windows.data.min), aperture(looks.aperture),
      frame(picture_frame(ldi.windows, looks)), field(looks, lens, frame), cat_eye(aperture, looks, frame) {}

std::size_t Optics::doubled(const Imath::V2i &first, int size) const {
    if (!cat_eye.cuts()) return 0;
    const double left = cat_eye.share(CatEye::Light::evenly, Imath::V2d(first) + Imath::V2d(size / 2));
    return left <= 0.25 ? 2 : left <= 0.5 ? 1 : 0;
}

float Optics::widest() const {
    return float(std::max(aperture.half_extent().x, aperture.half_extent().y * frame.pixel_aspect));
}

void Optics::bend(BlockedSamples &samples) const {
    if (!moves() && coc == 0 && field.flat()) return;
    parallel_for(samples.blocks.size(), [&](std::size_t b) {
        SampleBlock &block = samples.blocks[b];
        for (std::uint32_t i = block.begin; i < block.end; ++i) {
            const Imath::V2d p = Imath::V2d(double(samples.x[i]), double(samples.y[i])) + Imath::V2d(corner);
            const Imath::V2d at = field.shown_at(p) - Imath::V2d(corner);
            const auto bent = [&](float of) { return float(field.bent(double(of) + coc, p)); };
            samples.coc[i] = bent(samples.coc[i]);
            if (!samples.surface_coc.empty()) samples.surface_coc[i] = bent(samples.surface_coc[i]);
            samples.x[i] = float(at.x);
            samples.y[i] = float(at.y);
        }
        bound(block, samples);
    });
}

float Optics::narrowest() const {
    return float(std::min(aperture.half_extent().x, aperture.half_extent().y * frame.pixel_aspect));
}

Imath::V2d Optics::coc_gradient(const Imath::V2i &first, int size) const {
    if (field.flat()) return {0, 0};
    const Imath::V2d middle = Imath::V2d(first) + Imath::V2d(size / 2);
    return field.coc_gradient(frame.magnified(middle, 1 / looks.magnification));
}

Imath::V2d Optics::skew(const Imath::V2d &p) const {
    return field.skew(frame.magnified(p, 1 / looks.magnification));
}

double Optics::displaced(const Imath::V2i &first, int size) const {
    const Imath::V2d most = aperture.half_extent();
    return skew(Imath::V2d(first) + Imath::V2d(size / 2)).length() * std::max(most.x, most.y) *
           std::max(1.0, frame.pixel_aspect);
}

std::vector<LensSample> Optics::bent(std::span<const LensSample> points, const Imath::V2i &first,
                                     int size) const {
    const Imath::V2d gradient = coc_gradient(first, size), s = skew(Imath::V2d(first) + Imath::V2d(size / 2));
    std::vector<LensSample> moved(points.begin(), points.end());
    for (LensSample &p : moved) {
        const Imath::V2d all = skewed(s, {double(p.x), -double(p.y) / frame.pixel_aspect});
        const auto factor = float(stretch(gradient, {double(p.x), double(p.y)}));
        p.x *= factor;
        p.y *= factor;
        p.pixel_x += factor * float(all.x);
        p.pixel_y -= factor * float(all.y * frame.pixel_aspect);
    }
    return moved;
}

Darkening::Darkening(const CatEye &cat_eye, const Ldi &ldi, const Windows &windows)
    : windows_(windows), sets_(colour_sets(ldi, ldi.channels.size())) {
    if (!cat_eye.darkens()) return;
    left_.resize(windows.pixels());
    const Imath::Box2i &window = windows.data;
    parallel_for(std::size_t(windows.height()), [&](std::size_t row) {
        const int y = window.min.y + int(row);
        std::ranges::copy(cat_eye.shares(CatEye::Light::evenly, {{window.min.x, y}, {window.max.x, y}}),
                          &left_[row * std::size_t(windows.width())]);
    });
}

void Darkening::darken(Image &image) const {
    if (left_.empty()) return;
    for (std::size_t k = 0; k < sets_.size(); ++k)
        if (is_colour(sets_[k]))
            std::ranges::transform(image.plane(k), left_, image.plane(k).begin(), std::multiplies());
}

} // namespace sparselens
