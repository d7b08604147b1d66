// The function write of the module: LDIs, pictures and plans as files; and pictures as notebooks show them.
#pragma once

#include "python/objects.h"

namespace sparselens::python {

// PNG bytes for a notebook: through the default display and view, as dof-gather writes PNG. None of a picture without R, G
// and B, of which a notebook then shows the text.
py::object png_of(const PictureObject &picture);

void write(const py::object &path, const py::object &what, const py::kwargs &keywords);

} // namespace sparselens::python
