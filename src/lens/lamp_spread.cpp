#include "lens/lamp_spread.h"

#include "lens/polygon_pixels.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

namespace {

// From places of ApertureShape to pixels: their scale, negative where an axis is mirrored.
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

void spread_outline(const Aperture &aperture, const Lamp &lamp, LampSpread &spread) {
    const Imath::V2d scale = scale_of(aperture, lamp);
    std::vector<Imath::V2d> polygon;
    for (const Imath::V2d &a :
         aperture.outline(std::abs(lamp.coc) * std::max(1.0, 1 / aperture.shape().squeeze)))
        polygon.emplace_back(lamp.centre.x + scale.x * a.x, lamp.centre.y + scale.y * a.y);
    const double area = std::abs(signed_area(polygon)), at_middle = aperture.weight(lamp.coc > 0, 0),
                 at_rim = aperture.weight(lamp.coc > 0, 1);
    const RadialDensity density{
        at_middle / area, (at_rim - at_middle) / area, lamp.centre, {1 / scale.x, 1 / scale.y}};
    integrate_over_pixels(polygon, density, spread.box, spread.weights);
}

void spread_picture(const Aperture &aperture, const PictureTable &picture, const Lamp &lamp,
                    LampSpread &spread) {
    const Imath::V2d scale = scale_of(aperture, lamp);
    spread.coloured = picture.coloured();
    for (int y = spread.box.min.y; y <= spread.box.max.y; ++y)
        for (int x = spread.box.min.x; x <= spread.box.max.x; ++x) {
            Imath::Box2d place;
            for (const int corner : {0, 1})
                place.extendBy(Imath::V2d((x + corner - lamp.centre.x) / scale.x,
                                          (y + corner - lamp.centre.y) / scale.y));
            const LightOfColours share = picture.share(place);
            spread.weights.push_back(share[3]);
            if (spread.coloured) spread.colours.push_back({share[0], share[1], share[2]});
        }
}

} // namespace

LampSpread spread_lamp(const Aperture &aperture, const Lamp &lamp, const Imath::Box2i &box) {
    LampSpread spread{reached(aperture, lamp, box), false, {}, {}};
    if (spread.box.isEmpty()) return spread;
    if (const PictureTable *picture = aperture.picture(lamp.coc > 0))
        spread_picture(aperture, *picture, lamp, spread);
    else
        spread_outline(aperture, lamp, spread);
    return spread;
}

} // namespace sparselens
