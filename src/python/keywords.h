// The keyword arguments of a function, which are named as the tools' options, with _ for -.
//
// A keyword that is None counts as not given. Throws TypeError (a wrong type, an unknown keyword) or UsageError (a
// wrong value), which name the keyword.
#pragma once

#include "chain/parameters.h"

#include <Imath/ImathBox.h>
#include <pybind11/pybind11.h>

#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace sparselens::python {

namespace py = pybind11;

class Keywords {
public:
    Keywords(const char *function, const py::kwargs &given); // the function is for messages

    py::object take(const char *name); // None if it is not given
    bool flag(const char *name);       // False if it is not given
    std::optional<double> number(const char *name, NumberRange range = above_0);
    // Takes the parameters of a table. Values that are not given stay as they are.
    template <typename Values>
    void parameters(ParameterRows<Values> rows, Values &values) {
        for (const ParameterOf<Values> &row : rows)
            parameter(row, [&](const std::string &text) { return row.put(values, text); });
    }
    std::optional<int> whole(const char *name, int least, int most);
    std::string text(const char *name); // empty if it is not given
    std::string path(const char *name);
    // A str, or a sequence of str, as a comma-separated list; empty if it is not given.
    std::string list(const char *name);
    std::optional<Imath::V2d> pair(const char *name);  // two finite numbers
    std::optional<Imath::V2i> pixel(const char *name); // two whole numbers
    std::optional<Imath::Box2i> box(const char *name); // left, top, right, bottom; the last ones included

    // Takes one of a few words.
    template <typename Value>
    std::optional<Value> word(const char *name, std::initializer_list<std::pair<const char *, Value>> words) {
        const std::string given = text(name);
        if (given.empty()) return {};
        std::string all;
        for (const auto &[word, value] : words) {
            if (given == word) return value;
            all += (all.empty() ? "" : ", ") + std::string(word);
        }
        refuse(name, "one of " + all, given);
    }

    bool is_given(const std::string &name) const; // for keywords that were taken
    // Throws TypeError if a keyword was given but not taken, and as check_together() does.
    void done() const;

    [[noreturn]] static void refuse(const char *name, const std::string &wanted, const std::string &found);

private:
    void parameter(const Parameter &row, const std::function<bool(const std::string &)> &put);
    std::optional<std::string> text_of(const Parameter &row, const char *name);

    std::string function_;
    py::dict left_;
    std::vector<std::string> known_, given_; // all that were taken, and those of them that were given
};

LensValues lens_values(Keywords &keywords);
PictureChoice picture_choice(Keywords &keywords);
DepthOptions depth_options(Keywords &keywords); // with picture_choice()
OpenOptions file_options(Keywords &keywords);   // all of the above, and depth_file: how a file is opened

[[noreturn]] void wrong_type(const char *name, const char *wanted, const py::handle &found);

// The file name in a str or os.PathLike.
std::string path_of(const py::object &path, const char *name);

} // namespace sparselens::python
