// Values keyed by frame: 1:5.0,24:2.0 are two numbers, 1:10,20;24:30,40 two pixels. Values are interpolated linearly
// between keys, and constant before the first key and after the last.
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
    std::map<int, KeyValue> by_frame = {}; // not empty
    bool percent = false;                  // of all numbers: 1:2%,24:4%
};

// Parses FRAME:VALUE,FRAME:VALUE or FRAME:X,Y;FRAME:X,Y; nothing if the text is not such a list. Throws UsageError if a
// frame occurs twice.
std::optional<Keys> parse_keys(std::string_view text, KeyKind kind);

// Reads keys from a text file: lists as above, one or more lines; empty lines and lines that start with # are ignored.
// A file of JSON, as dof-match writes it, has numbers for several options: {"focus_distance": {"1": 5.0}, ...}; `option`
// (--focus-distance) says which to read. Throws UsageError with the file and the line if a line is not a list, or if the
// JSON has no numbers for the option; Error if the file cannot be read.
Keys read_keys(const std::string &path, KeyKind kind, std::string_view option = {});

// The value at a frame as a word of a command line; pixels are rounded to whole ones.
std::string word_at_frame(const Keys &keys, int frame);

} // namespace sparselens
