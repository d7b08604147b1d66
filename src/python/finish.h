// The function finish of the module.
#pragma once

#include "python/objects.h"

namespace sparselens::python {

py::dict finish(const py::object &gathered, const py::object &rays, const py::kwargs &keywords);

} // namespace sparselens::python
