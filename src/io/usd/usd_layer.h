// The part of a layer of Universal Scene Description (USD) that describes cameras and how they are rendered.
//
// Prims without cameras or render settings below them, and attributes of other kinds, are left out. Values are numbers
// in the order of the text, without their brackets, or texts: tokens, strings and paths.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace sparselens {

struct UsdValue {
    std::vector<double> numbers = {};
    std::vector<std::string> texts = {};
};

struct UsdAttribute {
    std::optional<UsdValue> value = {};
    std::map<double, UsdValue> samples = {}; // by time code; they take precedence over `value`
    std::string source = {};                 // "spline" or "connect" if the values come from there
};

struct UsdPrim {
    std::string name = {}, type = {}; // "Camera", "Xform", ...; may be empty
    bool defined = false;             // by `def`; otherwise only changed (`over`) or inherited from (`class`)
    bool active = true;
    std::string composed =
        {}; // the first statement that takes contents from elsewhere: "references", "payload", ...
    std::map<std::string, UsdAttribute, std::less<>> attributes = {};
    std::vector<UsdPrim> children = {};
};

struct UsdLayer {
    std::string file = {}; // for messages
    double metres_per_unit = 0.01;
    char up_axis = 'Y'; // or Z
    double frames_per_second = 24;
    std::string render_settings = {}; // the path of the settings to use; empty: not stated
    std::string composed = {};        // as in UsdPrim, anywhere in the file
    UsdPrim root = {};
};

// A prim and its ancestors, the uppermost first.
using UsdPath = std::vector<const UsdPrim *>;

// All active prims of the type that are defined, in the order of the file.
std::vector<UsdPath> prims_of_type(const UsdLayer &layer, std::string_view type);

std::string text_of(const UsdPath &path); // "/World/camera"

// The attribute, or null.
const UsdAttribute *find_attribute(const UsdPrim &prim, std::string_view name);

// The only text of an attribute that is not animated, such as a token; empty if it has none.
std::string text_value(const UsdPrim &prim, std::string_view name);

// Reads a textual layer (.usda), by the grammar of OpenUSD's "Usda File Format" (usd_read.cpp). Throws Error, naming
// the file and the line, if the file cannot be read, is not textual USD, is nested deeper than 64 levels, or has more
// than 10,000 cameras and settings or a million time samples. Binary files (.usdc, .usdz) are refused with the command
// that converts them. `-` is standard input.
UsdLayer read_usd(const std::string &path);

} // namespace sparselens
