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

// The constructors of Python's classes, from numpy arrays. Views and LDIs are prepared like files (prepare_view,
// prepare_ldi): depth is planar, invalid values are repaired, samples are tidy. The errors are those of arrays.h and
// keywords.h.

// `z` is an array, or None if the depth is a channel of the image.
ViewObject view_from(const py::object &image, const py::object &z, const py::kwargs &keywords);
LdiObject ldi_from(const py::object &begin, const py::object &z, const py::object &channels,
                   const py::kwargs &keywords);
PictureObject picture_from(const py::object &image, const py::kwargs &keywords);

} // namespace sparselens::python
