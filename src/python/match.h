// The function match of the module.
#pragma once

#include "python/objects.h"

namespace sparselens::python {

py::object match(const py::object &ldi, const py::object &plate, const py::kwargs &keywords);

} // namespace sparselens::python
