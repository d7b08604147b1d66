// Values keyed by frame: 1:5.0,24:2.0 are two numbers, 1:10,20;24:30,40 two pixels. Between the keys they are linear,
// before the first and after the last constant.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace sparselens {

enum class KeyKind { number, pixel, pair }; // a pixel is X,Y in whole pixels, a pair X,Y of any numbers

// The value of each key: one number, or X and Y.
struct KeyValue {
    double x = 0, y = 0;
};

struct Keys {
    KeyKind kind = KeyKind::number;
    std::map<int, KeyValue> by_frame; // not empty
};

// FRAME:VALUE,FRAME:VALUE or FRAME:X,Y;FRAME:X,Y, or nothing where the text is not such a list. Throws UsageError where
// a frame is given twice.
std::optional<Keys> parse_keys(std::string_view text, KeyKind kind);

// The keys in a text file: lists as above, one a line or more; empty lines and lines that start with # do not count.
// Throws UsageError, naming the file and the line, where one is not a list; Error where the file cannot be read.
Keys read_keys(const std::string &path, KeyKind kind);

// The value at a frame as a word of a command line; pixels are rounded to whole ones.
std::string word_at_frame(const Keys &keys, int frame);

} // namespace sparselens
