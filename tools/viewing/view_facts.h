// Facts that a page shows beside the picture: about the lens, and the samples of a pixel. As JSON, with infinity as
// "inf".
#pragma once

#include "viewing/shot.h"
#include "viewing/view_words.h"

#include <nlohmann/json.hpp>

#include <cstdint>

namespace sparselens {

// Focus, f-number, sharp range (a CoC of at most a pixel), hyperfocal distance, the largest CoC, warnings.
nlohmann::json lens_facts(const ShotPicture &picture);

// The controls of the looks of the lens, from the table of parameters: a choice of words, a number or a pair; which of
// them can be keyed by frame.
nlohmann::json look_controls(const Presets &lenses);

// The samples of a pixel of the picture (of its middle sub-pixel), front to back: depth, CoC, alpha, colour, objects.
nlohmann::json sample_facts(const ShotFrame &frame, const ThinLens &lens, const Imath::V2i &pixel);

// The frontmost objects in the pixels of the picture. `said`: for each object its name, and focus and hyperfocal
// distance of the widest lens for which all of it is sharp. `numbers`: two bytes for each pixel, the lower first: the
// object's number, from 1 to 65535; 0: no object, or one beyond 65535.
struct ObjectMap {
    nlohmann::json said;
    std::vector<std::uint8_t> numbers;
};
ObjectMap object_map(const ShotFrame &frame);

// A number that JSON can hold, else "inf".
nlohmann::json json_number(double value);

} // namespace sparselens
