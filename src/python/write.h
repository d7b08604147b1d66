// The function write of the module, which writes LDIs, pictures and plans to files; and PNG pictures for notebooks.
#pragma once

#include "python/objects.h"

namespace sparselens::python {

// Returns PNG bytes for a notebook, through the default display and view, as dof-gather writes PNG. Returns None for a
// picture without R, G and B; a notebook then shows its text.
py::object png_of(const PictureObject &picture);

void write(const py::object &path, const py::object &what, const py::kwargs &keywords);

} // namespace sparselens::python
