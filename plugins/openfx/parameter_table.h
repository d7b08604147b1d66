// The parameters that the plug-in shows, from the table that the tools, Python and dof-view's page share
// (tools/ofx-parameters.cpp prints it while the plug-in is built).
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sparselens_ofx {

enum class ParameterKind { flag, whole, number, pair, choice, text, file };

struct ParameterRow {
    const char *name; // of the parameter; the setting has - for _
    const char *label, *hint;
    const char *group; // "": none
    ParameterKind kind;
    double nothing;   // the number that leaves the choice to the file or the method
    double low, high; // ends of the slider
    bool keyable;
    const char *needs; // the parameter without which this one says nothing; "": none
    const char *words; // of a choice, separated by |; its first option, 0, is none of them
};

std::span<const ParameterRow> parameter_table();

std::vector<std::string> words_of(const ParameterRow &row);

// focus-distance of focus_distance.
std::string setting_of(std::string_view name);

// A pair is two parameters, because not every host gives the numbers of a pair in their order.
std::string name_x(const ParameterRow &row);
std::string name_y(const ParameterRow &row);

// The plug-in's own parameters.
inline constexpr const char *ldi_parameter = "ldi", *offset_parameter = "frame_offset";

} // namespace sparselens_ofx
