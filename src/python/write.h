// The function write of the module: LDIs, pictures and plans as files.
#pragma once

#include "python/objects.h"

namespace sparselens::python {

void write(const py::object &path, const py::object &what, const py::kwargs &keywords);

} // namespace sparselens::python
