// Small flat pictures for tests: of one colour or with a few rectangles, and what a few words change about one that is there.
#pragma once

#include "pictures/picture.h"

#include <span>
#include <string>

namespace pictures {

// WIDTHxHEIGHT, WIDTHxHEIGHT+X+Y: a window. Throws std::invalid_argument.
Imath::Box2i window_of(const std::string &text);

// A picture without channels, whose display window is its data window.
Picture blank(const Imath::Box2i &window);

// Words, in the order in which they work:
//   NAME=VALUE          the channel's value everywhere; makes the channel (of floats) where there is none. VALUE may be inf, nan
//   NAME=LEFT..RIGHT    from the left column's to the right one's, evenly
//   NAME=noise:SEED     random, from 0 to 1
//   NAME*=VALUE         times that
//   fill=WINDOW         what follows up to all= is set or multiplied in there only
//   all=                everywhere again
//   half=NAMES, float=NAMES     the type of channels, by commas; all channels without names
//   channels=NAMES      these alone; NEW=OLD for one under another name
//   crop=WINDOW         the data window; transparent black where nothing was
//   frame=WINDOW        the display window
//   erase=PATTERN       attributes whose whole names match the extended regular expression
//   set=NAME:NUMBER, set=NAME:TEXT      an attribute
// Throws std::exception that names the word.
void edit(Picture &picture, std::span<const std::string> words);

} // namespace pictures
