// What a page says beside the picture: of the lens, and of the samples of a pixel. As JSON, in which infinity is "inf".
#pragma once

#include "viewing/shot.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <map>
#include <string>

namespace sparselens {

// The names of objects by their ids, as the manifests of Cryptomattes in the header have them.
using ObjectNames = std::map<std::uint32_t, std::string>;
ObjectNames object_names(const Imf::Header &header);

// The depths that the picture has, in (0, inf]; 1 and 1 where it has no samples. What images show counts too.
struct DepthExtent {
    double nearest = 1, farthest = 1;
};
DepthExtent depth_extent(const Ldi &ldi);

// Focus, f-number, what is sharp (a CoC of at most a pixel), hyperfocal distance, the largest CoC, warnings.
nlohmann::json lens_facts(const TakenPicture &picture, const DepthExtent &depths);

// The samples of a pixel of the picture (of its middle sub-pixel), front to back: depth, CoC, alpha, colour, objects.
nlohmann::json sample_facts(const Shot &shot, const ThinLens &lens, const Imath::V2i &pixel,
                            const ObjectNames &names);

// The objects that the pixels of the picture show in front. `said`: their names, and the focus and the hyperfocal distance of
// the widest lens that is sharp all over each. `numbers`: two bytes for each pixel, the lower first: which it is, from 1.
struct ObjectMap {
    nlohmann::json said;
    std::vector<std::uint8_t> numbers;
};
ObjectMap object_map(const Shot &shot, const ObjectNames &names);

// A number that JSON can hold, else "inf".
nlohmann::json json_number(double value);

} // namespace sparselens
