// What a page says beside the picture: of the lens, and of the samples of a pixel. As JSON, in which infinity is "inf".
#pragma once

#include "viewing/shot.h"

#include <nlohmann/json.hpp>

#include <cstdint>

namespace sparselens {

// Focus, f-number, what is sharp (a CoC of at most a pixel), hyperfocal distance, the largest CoC, warnings.
nlohmann::json lens_facts(const ShotPicture &picture);

// The samples of a pixel of the picture (of its middle sub-pixel), front to back: depth, CoC, alpha, colour, objects.
nlohmann::json sample_facts(const ShotFrame &frame, const ThinLens &lens, const Imath::V2i &pixel);

// The objects that the pixels of the picture show in front. `said`: their names, and the focus and the hyperfocal distance of
// the widest lens that is sharp all over each. `numbers`: two bytes for each pixel, the lower first: which it is, from 1 to 65535; 0: none, or one of more.
struct ObjectMap {
    nlohmann::json said;
    std::vector<std::uint8_t> numbers;
};
ObjectMap object_map(const ShotFrame &frame);

// A number that JSON can hold, else "inf".
nlohmann::json json_number(double value);

} // namespace sparselens
