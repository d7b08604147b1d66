// How the table of parameters is written: what a row says, and where its value goes. For parameter_table.cpp alone.
#pragma once

#include "parameters.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <initializer_list>
#include <type_traits>
#include <utility>

namespace sparselens::parameter_rows {

using Form = ParameterForm;
template <typename Values>
using Rows = std::vector<ParameterOf<Values>>;

inline Parameter text(const char *name, std::string unit, std::string help, Form form = Form::text,
                      std::string wanted = "") {
    return {.name = name,
            .unit = std::move(unit),
            .help = std::move(help),
            .form = form,
            .wanted = std::move(wanted)};
}
inline Parameter flag(const char *name, const char *help) { return text(name, "", help, Form::flag); }
inline Parameter whole(const char *name, const char *unit, std::string help, int least, int most) {
    Parameter row = text(name, unit, std::move(help), Form::whole, fmt::format("from {} to {}", least, most));
    row.least = least;
    row.most = most;
    return row;
}
inline Parameter number(const char *name, const char *unit, std::string help, NumberRange range) {
    Parameter row = text(name, unit, std::move(help), Form::number, range.words);
    row.range = range;
    return row;
}
template <typename Values>
Parameter number(const NumberParameter<Values> &of) {
    return number(of.name, of.unit, of.help, of.range);
}
// One of a few words, in the order of an enum.
inline Parameter word(const char *name, std::vector<std::string> words, std::string help) {
    Parameter row = text(name, fmt::format("{}", fmt::join(words, "|")), std::move(help), Form::word,
                         fmt::format("one of {}", fmt::join(words, ", ")));
    row.words = std::move(words);
    return row;
}
inline Parameter in_group(const char *group, Parameter row) {
    row.group = group;
    return row;
}
inline Parameter on_page(Parameter row, PageControl control = {}) {
    row.page = true;
    row.control = control;
    return row;
}
inline Parameter keyed(Parameter row) {
    row.keyable = true;
    return row;
}
inline Parameter or_share(Parameter row) {
    row.or_share = true;
    row.wanted += ", or a share of the picture's width (e.g. 2%)";
    return row;
}
inline Parameter of_tools(Parameter row) { // Python has it elsewhere, or not at all
    row.python = PythonCall::none;
    return row;
}

// Read the value of a row from text.
bool read_place(const Parameter &row, const std::string &text, double &place);
bool read_place(const Parameter &row, const std::string &text, int &place);
bool read_place(const Parameter &row, const std::string &text, PhotographBlur &place);
bool read_place(const Parameter &row, const std::string &text, Imath::V2d &place);
bool read_place(const Parameter &row, const std::string &text, Imath::V2i &place);
bool read_place(const Parameter &row, const std::string &text, Imath::Box2i &place);
inline bool read_place(const Parameter &, const std::string &text, std::string &place) {
    return place = text, true;
}
inline bool read_place(const Parameter &, const std::string &, bool &place) { return place = true; }
std::size_t index_of(const Parameter &row, const std::string &text); // among its words; else their number
template <typename Enum>
requires std::is_enum_v<Enum>
bool read_place(const Parameter &row, const std::string &text, Enum &place) {
    place = Enum(index_of(row, text));
    return index_of(row, text) < row.words.size();
}
template <typename Value>
bool read_place(const Parameter &row, const std::string &text, std::optional<Value> &place) {
    return read_place(row, text, place.emplace());
}

// Puts the value into a member of the values, or into a member of that member, and so on.
template <typename... Members>
auto in(Members... members) {
    return [=](const Parameter &row, const std::string &text, auto &values) {
        return read_place(row, text, (values.*....*members));
    };
}

// Gives all rows this method, this group if they have none, and this call, except to rows that are of_tools().
template <typename Values>
Rows<Values> all(Rows<Values> rows, const char *group, const char *method = "",
                 PythonCall python = PythonCall::gather) {
    for (Parameter &row : rows) {
        if (*row.group == '\0') row.group = group;
        row.method = method;
        if (row.python != PythonCall::none) row.python = python;
    }
    return rows;
}

template <typename Values>
Rows<Values> joined(std::initializer_list<Rows<Values>> parts) {
    Rows<Values> rows;
    for (const Rows<Values> &part : parts) rows.insert(rows.end(), part.begin(), part.end());
    return rows;
}

} // namespace sparselens::parameter_rows
