// Checks whether the rays and the gathered picture differ as by a mistake: another exposure, or a shifted picture.
// Finishing would blur over it.
//
// The difference of each render from the gathered picture is fitted by the change that the mistake would make: the
// picture itself, or its slope across or down. The product of the two fits holds no noise of the renders. Its share of
// the product of the two differences says how much of them the mistake explains. Blocks that it explains badly count
// little, so that light that is missing in a gathered picture is not taken for exposure.
//
// Another radius, focus or shape of the lens cannot be distinguished from the usual errors of gathered pictures. Fitted
// in the same way by pictures that are gathered with 5 % more radius, 3 % more focus distance or six blades, good
// pictures of eleven scenes show up to .9, .75 and .9 of such a mistake, and more with lamps. So the headers are
// compared instead.
#pragma once

#include "finish/finish.h"
#include "view/view.h"

#include <Imath/half.h>

#include <optional>
#include <string>
#include <vector>

namespace sparselens {

struct LensMistakes {
    std::optional<double> brightness;  // of the gathered picture, relative to the rays
    std::optional<double> right, down; // offset of the gathered picture from the rays', pixels

    std::vector<std::string> warnings() const;
};

LensMistakes check_lens(const LayerToFinish &layer);

// What one channel of two renders and of the gathered picture tells about their noise. Values that are not finite are
// left out.
//
// The renders differ by noise alone, which is independent from pixel to pixel: in a block, two nearby pixels are
// brighter in the same render no more often than by chance. If they are more often, the renders are denoised, or differ
// in what they show. Each render's share of the squared difference is the product of the difference and the render's
// difference from the gathered picture.
struct NoiseOfTwo {
    double equal =
        0; // the share of pixels, among those that differ from the pixel before, that are the same in both
    double excess = 0;       // the share of pixels that are rough, and smooth in the gathered picture
    double equal_excess = 0; // the share of these that are the same in both
    double multiple = 0;     // 1 if one render is a multiple of the other; 1/2 at most for independent noise
    double alike = 0;        // the share of pairs of pixels that agree beyond chance
    std::array<double, 2> of_each{0.5, 0.5}; // shares of the noise
    bool same() const;
};

NoiseOfTwo noise_of_two(std::span<const half> first, std::span<const half> second,
                        std::span<const half> gathered, const ArrayGrid &grid);

// Compares the lenses and cameras of a gathered picture and a render by their headers. Returns the differences in
// words: of the aperture's radius, blades (0: none), rotation and squeeze, of the focus distance, of where the camera
// stands and looks, and of its focal length and shift. Values that a header lacks are not compared, except that the
// gathered picture then has a squeeze of 1, and blades have a rotation of 0.
std::vector<std::string> lens_differences(const Camera &gathered, const Camera &render);

} // namespace sparselens
