// The functions of the module that have files of their own.
#pragma once

#include "python/objects.h"

namespace sparselens::python {

// The picture that a lens takes from an LDI.
PictureObject gather(const py::object &ldi, const py::kwargs &keywords);

py::object match(const py::object &ldi, const py::object &plate, const py::kwargs &keywords);

py::dict finish(const py::object &gathered, const py::object &rays, const py::kwargs &keywords);

// Writes LDIs, pictures and plans to files.
void write(const py::object &path, const py::object &what, const py::kwargs &keywords);

// Returns PNG bytes for a notebook, through the default display and view, as dof-gather writes PNG. Returns None for a
// picture without R, G and B; a notebook then shows its text.
py::object png_of(const PictureObject &picture);

} // namespace sparselens::python
