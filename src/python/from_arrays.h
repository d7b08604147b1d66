// Makes views, LDIs and pictures from numpy arrays, for the constructors of the Python classes. Views and LDIs are
// prepared like files (prepare_view, prepare_ldi): depth is planar, invalid values are repaired, samples are tidy. The
// errors are those of arrays.h and keywords.h.
#pragma once

#include "python/objects.h"

namespace sparselens::python {

// `z` is an array, or None if the depth is a channel of the image.
ViewObject view_from(const py::object &image, const py::object &z, const py::kwargs &keywords);
LdiObject ldi_from(const py::object &begin, const py::object &z, const py::object &channels,
                   const py::kwargs &keywords);
PictureObject picture_from(const py::object &image, const py::kwargs &keywords);

} // namespace sparselens::python
