// The function gather of the module: the picture that a lens takes from an LDI.
#pragma once

#include "python/objects.h"

namespace sparselens::python {

PictureObject gather(const py::object &ldi, const py::kwargs &keywords);

} // namespace sparselens::python
