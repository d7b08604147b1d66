// The parameters of a picture: one table from which come the options of the tools, the keywords of Python, the controls
// of dof-view's page, and which values can be keyed by frame. It includes the numbers of the lens and of its looks from
// their own tables (view/resolve_lens.h, looks/table.h).
#pragma once

#include "looks/look.h"
#include "take_picture.h"

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sparselens {

// The form of a value. The text of a flag is empty; numbers are separated by commas.
enum class ParameterForm {
    flag,
    whole,
    number,
    word,   // one of a few
    text,   // anything
    list,   // words separated by commas
    file,   // the name of a file
    ldi,    // the name of a deep file; in Python an object
    device, // as for choose_device() of gpu/device_list.h
    pair,   // two finite numbers
    pixel,  // two whole numbers, EXR coordinates
    box,    // four whole numbers: left, top, right, bottom, the last ones included
};

// The function of the Python module that takes a parameter.
enum class PythonCall { open_ldi, gather, write, none };

struct Parameter {
    std::string name; // of the option, without dashes; in keywords and messages with _ for -
    std::string unit; // "MM", "X,Y", "draft|normal|final"
    std::string help; // with other parameters in backquotes, as in messages (base/error.h)
    ParameterForm form = ParameterForm::text;
    std::string wanted = {};             // what a value must be, for messages
    NumberRange range = above_0;         // of a number
    int least = 0, most = 0;             // of a whole number
    std::vector<std::string> words = {}; // of a word
    const char *group = "";              // of options in --help; empty: the first one
    const char *method = "";             // the only gather method that has it; empty: all
    bool or_share = false;               // a number that may also be a share of the picture's width: 2%
    bool keyable = false;                // may have values keyed by frame
    bool page = false;                   // a page of dof-view may set it
    PageControl control = {};
    PythonCall python = PythonCall::gather;
};

template <typename Values>
struct ParameterOf : Parameter {
    // Puts the value that is written in `text` among the values. Returns false if it is not `wanted`.
    bool put(Values &values, const std::string &text) const { return read(*this, text, values); }
    std::function<bool(const Parameter &, const std::string &text, Values &)> read;
};
template <typename Values>
using ParameterRows = std::span<const ParameterOf<Values>>;

ParameterRows<LensValues> lens_parameters();
ParameterRows<GivenLooks> look_parameters(); // also the highlights
ParameterRows<DepthOptions> depth_parameters();
ParameterRows<PictureChoice> choice_parameters();     // which picture of a file
ParameterRows<PictureChoice> kind_parameters();       // what its channels hold
ParameterRows<PictureChoice> depth_file_parameters(); // one row
ParameterRows<DepthOptions> photograph_parameters();  // one row
ParameterRows<ColourOptions> input_colour_parameters();
ParameterRows<ColourOptions> output_colour_parameters();
ParameterRows<WindowOptions> window_parameters();
ParameterRows<PictureRequest> gather_parameters(); // the method, what is gathered, and how
ParameterRows<PictureRequest> shown_parameters();  // what is shown in place of the picture

// All of them, and one by its name; null: there is none.
std::span<const Parameter *const> picture_parameters();
const Parameter *find_parameter(std::string_view name);

// The name with _ for -.
std::string keyword_of(std::string_view name);

bool exclude(std::string_view one, std::string_view other); // at most one of the two may be given
bool needs(std::string_view one, std::string_view other);   // `one` only with `other`

// Throws UsageError if parameters are given that exclude each other, or one without another that it needs.
using IsGiven = std::function<bool(const std::string &keyword)>;
void check_together(const IsGiven &is_given);

// Reads numbers that are separated by commas. Returns false if the text is something else.
bool read_numbers(const std::string &text, std::span<double> numbers);

} // namespace sparselens
