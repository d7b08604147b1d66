#include "lens/lamp_spread.h"

#include "lens/polygon_pixels.h"

#include <cmath>
#include <utility>

namespace sparselens {

namespace {

using Points = std::vector<Imath::V2d>;

// The scale from places of ApertureShape to pixels, negative where an axis is mirrored.
Imath::V2d scale_of(const Aperture &aperture, const Lamp &lamp) {
    return {lamp.coc / aperture.shape().squeeze, -lamp.coc * lamp.pixel_aspect};
}

// The pixels of a box that the lamp's light can reach.
Imath::Box2i reached(const Aperture &aperture, const Lamp &lamp, const Imath::Box2i &box) {
    const Imath::V2d extent = aperture.half_extent() * std::abs(lamp.coc);
    const auto pixel = [](double v, int low, int high) {
        return int(std::clamp(std::floor(v), double(low), double(high)));
    };
    const Imath::V2d low(lamp.centre.x - extent.x, lamp.centre.y - extent.y * lamp.pixel_aspect),
        high(lamp.centre.x + extent.x, lamp.centre.y + extent.y * lamp.pixel_aspect);
    if (high.x < box.min.x || low.x > box.max.x + 1 || high.y < box.min.y || low.y > box.max.y + 1) return {};
    return {{pixel(low.x, box.min.x, box.max.x), pixel(low.y, box.min.y, box.max.y)},
            {pixel(high.x, box.min.x, box.max.x), pixel(high.y, box.min.y, box.max.y)}};
}

constexpr double cut_tolerance = 1e-3; // pixels, of arcs

// The part of an outline that passes the cut.
Points cut_outline(Points outline, const LampCut &cut, double coc) {
    for (Imath::V2d &p : outline) p *= cut.scale;
    if (cut.scale.x * cut.scale.y < 0) std::reverse(outline.begin(), outline.end());
    Points left = within_unit_circle(outline, cut.centre, cut_tolerance / std::max(4.0, coc));
    for (Imath::V2d &p : left) p /= cut.scale;
    return left;
}

Points in_pixels(Points places, const Aperture &aperture, const Lamp &lamp) {
    const Imath::V2d scale = scale_of(aperture, lamp);
    for (Imath::V2d &p : places) p = lamp.centre + p * scale;
    return places;
}

void spread_outline(const Aperture &aperture, const Lamp &lamp, const LampCut *cut, LampSpread &spread) {
    const Imath::V2d scale = scale_of(aperture, lamp);
    const double widest = std::max(std::abs(scale.x), std::abs(scale.y));
    Points outline = aperture.outline(widest);
    const double area = std::abs(signed_area(outline) * scale.x * scale.y);
    if (cut) outline = cut_outline(std::move(outline), *cut, widest);
    const Points places = in_pixels(std::move(outline), aperture, lamp);
    const auto spread_colour = [&](std::size_t colour, std::vector<double> &weights) {
        const double at_middle = aperture.weight(lamp.coc > 0, 0, colour),
                     at_rim = aperture.weight(lamp.coc > 0, 1, colour);
        const RadialDensity density{
            at_middle / area, (at_rim - at_middle) / area, lamp.centre, {1 / scale.x, 1 / scale.y}};
        integrate_over_pixels(places, density, spread.box, weights);
    };
    spread_colour(1, spread.weights);
    spread.coloured = aperture.coloured_rims();
    if (!spread.coloured) return;
    std::vector<double> red, blue;
    spread_colour(0, red);
    spread_colour(2, blue);
    for (std::size_t i = 0; i < spread.weights.size(); ++i)
        spread.colours.push_back({red[i], spread.weights[i], blue[i]});
}

void spread_picture(const Aperture &aperture, const PictureTable &picture, const Lamp &lamp,
                    LampSpread &spread) {
    const Imath::V2d scale = scale_of(aperture, lamp);
    spread.coloured = picture.coloured();
    for (int y = spread.box.min.y; y <= spread.box.max.y; ++y)
        for (int x = spread.box.min.x; x <= spread.box.max.x; ++x) {
            Imath::Box2d place;
            for (const int corner : {0, 1})
                place.extendBy((Imath::V2d(x + corner, y + corner) - lamp.centre) / scale);
            const LightOfColours share = picture.share(place);
            spread.weights.push_back(share[3]);
            if (spread.coloured) spread.colours.push_back({share[0], share[1], share[2]});
        }
}

// A pixel of a picture keeps as much of its light as the circle covers of the pixel.
void cut_picture(const Aperture &aperture, const Lamp &lamp, const LampCut &cut, LampSpread &spread) {
    Points circle = aperture_outline({}, cut_tolerance / std::max(4.0, std::abs(lamp.coc)));
    for (Imath::V2d &p : circle) p = (cut.centre + p) / cut.scale;
    std::vector<double> kept;
    integrate_over_pixels(in_pixels(std::move(circle), aperture, lamp), {}, spread.box, kept);
    for (std::size_t i = 0; i < kept.size(); ++i) {
        spread.weights[i] *= std::min(1.0, kept[i]);
        if (spread.coloured)
            for (double &weight : spread.colours[i]) weight *= std::min(1.0, kept[i]);
    }
}

} // namespace

LampCut cut_of(const CatEye &cat_eye, const Aperture &aperture, const Lamp &lamp) {
    const double moved = cat_eye.shift_per_pixel() * lamp.coc;
    const auto not_0 = [](double v) { return std::abs(v) < 1e-6 ? 1e-6 : v; };
    return {{not_0(1 - moved / aperture.shape().squeeze), not_0(1 - moved)}, cat_eye.centre(lamp.centre)};
}

LampSpread spread_lamp(const Aperture &aperture, const Lamp &lamp, const Imath::Box2i &box,
                       const LampCut *cut) {
    LampSpread spread{reached(aperture, lamp, box), false, {}, {}};
    if (spread.box.isEmpty()) return spread;
    if (const PictureTable *picture = aperture.picture(lamp.coc > 0)) {
        spread_picture(aperture, *picture, lamp, spread);
        if (cut) cut_picture(aperture, lamp, *cut, spread);
    } else {
        spread_outline(aperture, lamp, cut, spread);
    }
    return spread;
}

} // namespace sparselens
