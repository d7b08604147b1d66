// The objects that the functions of the module take and return: the library's own structures, with what Python needs in
// addition.
#pragma once

#include "base/error.h"
#include "chain/plan_views.h"
#include "io/open_ldi.h"
#include "io/open_view.h"
#include "io/plan_file.h"

#include <pybind11/pybind11.h>

#include <optional>
#include <string>
#include <vector>

namespace sparselens::python {

namespace py = pybind11;

// Python calls these View, Ldi, Picture and Plan. Views and LDIs are never changed once they are made, so that work
// without the interpreter's lock may read them.
struct ViewObject {
    OpenedView in;
    std::optional<Imath::V2d> position = {}; // as the user states it, see StatedView
};
using LdiObject = OpenedLdi;
struct PictureObject {
    Image image;
    Imf::Header header; // kept in a file that the picture is written to
};
struct PlanObject {
    Plan plan;
    PlanSetting setting;
};
struct PlannedViewObject {
    PlannedView view;
    ThinLens lens;
};

// Returns the argument as one of these objects. Throws TypeError, which names the argument.
template <typename Object>
const Object &argument(const py::handle &object, const char *name, const char *wanted);

// Returns the argument as a sequence. Throws TypeError, which names the argument, for anything else, and for a str.
py::sequence sequence_of(const py::handle &given, const char *name, const char *wanted);

// Returns the objects of a sequence, or the single object. Throws TypeError, which names the argument, and UsageError
// if there is none.
template <typename Object>
std::vector<const Object *> several(const py::object &given, const char *name, const char *wanted);

// A message with its parameters (error.h) as keywords: depth='inverse'.
std::string with_keywords(const std::string &message);

// Raises Python warnings (UserWarning) about what was repaired in a file and what is probably a mistake.
void warn(const std::string &text);
void warn_of(const std::string &name, const OpenedFile &file);

void bind_objects(py::module_ &module);
void bind_verbs(py::module_ &module);

} // namespace sparselens::python

#include "python/keywords.h"

template <typename Object>
const Object &sparselens::python::argument(const py::handle &object, const char *name, const char *wanted) {
    if (!py::isinstance<Object>(object)) wrong_type(name, wanted, object);
    return object.cast<const Object &>();
}

template <typename Object>
std::vector<const Object *> sparselens::python::several(const py::object &given, const char *name,
                                                        const char *wanted) {
    if (py::isinstance<Object>(given)) return {&given.cast<const Object &>()};
    std::vector<const Object *> found;
    for (const py::handle &item : sequence_of(given, name, wanted))
        found.push_back(&argument<Object>(item, name, wanted));
    if (found.empty()) throw UsageError(std::string(name) + ": there is none");
    return found;
}
