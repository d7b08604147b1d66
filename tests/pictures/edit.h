// Small flat pictures for tests: of one colour or with a few rectangles, and edits of existing pictures by a few words.
#pragma once

#include "pictures/picture.h"

#include <span>
#include <string>

namespace pictures {

// Parses a window: WIDTHxHEIGHT or WIDTHxHEIGHT+X+Y. Throws std::invalid_argument.
Imath::Box2i window_of(const std::string &text);

// A picture without channels whose display window equals its data window.
Picture blank(const Imath::Box2i &window);

// The words are applied in order:
//   NAME=VALUE          the channel's value everywhere; a new one has floats. VALUE may be inf or nan
//   NAME=LEFT..RIGHT    a linear ramp from the left column to the right one
//   NAME=noise:SEED     random, from 0 to 1
//   NAME*=VALUE         multiplies by that
//   fill=WINDOW         the words up to all= set or multiply only inside this window
//   all=                everywhere again
//   half=NAMES, float=NAMES     the type of channels, separated by commas; all channels without names
//   channels=NAMES      keeps only these; NEW=OLD renames one
//   crop=WINDOW         the data window; transparent black where nothing was
//   frame=WINDOW        the display window
//   erase=PATTERN       attributes whose whole names match the extended regular expression
//   set=NAME:NUMBER, set=NAME:TEXT      an attribute
// Throws std::exception that names the word.
void edit(Picture &picture, std::span<const std::string> words);

} // namespace pictures
