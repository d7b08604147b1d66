#include "lab/reference/subpixels_slowly.h"

#include "base/matte.h"

#include <functional>

namespace sparselens {

namespace {

using Visit = std::function<void(int x, int y, double share)>;

bool is_there(const Image &fine, int x, int y) { return fine.windows.data.intersects(Imath::V2i(x, y)); }

// Whether a sub-pixel is in the smallest box around the data window and the display window; outside, its colour is
// unknown.
bool is_known(const Image &fine, int x, int y) {
    Imath::Box2i box = fine.windows.data;
    box.extendBy(fine.windows.display);
    return box.intersects(Imath::V2i(x, y));
}

// Visits all known sub-pixels of a pixel, with their shares.
void for_each_known(const Image &fine, const Subpixels &by, int x, int y, const Visit &visit) {
    const std::vector<double> shares = subpixel_shares(by);
    const Imath::Box2i under = subpixels_under({{x, y}, {x, y}}, by);
    for (int v = under.min.y; v <= under.max.y; ++v)
        for (int u = under.min.x; u <= under.max.x; ++u)
            if (is_known(fine, u, v))
                visit(u, v, shares[std::size_t(u - under.min.x)] * shares[std::size_t(v - under.min.y)]);
}

} // namespace

Image mean_of_subpixels_slowly(const Image &fine, const Subpixels &by, const Imath::Box2i &box) {
    Image out({reduced(fine.windows.display, by.across), box, fine.windows.pixel_aspect}, fine.channels);
    const std::vector<Matte> mattes = find_mattes(fine.channels);
    for (int y = box.min.y; y <= box.max.y; ++y)
        for (int x = box.min.x; x <= box.max.x; ++x) {
            double all = 0;
            for_each_known(fine, by, x, y, [&](int, int, double share) { all += share; });
            for (std::size_t k = 0; k < out.channels.size(); ++k) {
                const Imath::V2i at = middle_subpixel({x, y}, by.across);
                double sum = 0;
                for_each_known(fine, by, x, y, [&](int u, int v, double share) {
                    if (is_there(fine, u, v)) sum += share / all * double(fine.at(k, u, v));
                });
                out.at(k, x, y) = is_light(fine.channels[k])   ? float(sum)
                                  : is_there(fine, at.x, at.y) ? fine.at(k, at.x, at.y)
                                                               : 0;
            }
            MatteSum pairs(mattes);
            for_each_known(fine, by, x, y, [&](int u, int v, double share) {
                if (is_there(fine, u, v))
                    pairs.add(share / all, [&](std::size_t k) { return fine.at(k, u, v); });
            });
            pairs.take([&](std::size_t k, float value) { out.at(k, x, y) = value; });
        }
    return out;
}

} // namespace sparselens
