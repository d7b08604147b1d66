// The number of samples per pixel with which a picture was rendered, if its header has `sparselens:samples` (dof-trace)
// or `cycles.LAYER.samples` (Blender's Cycles; the largest of its layers, because adaptive sampling may take fewer).
#pragma once

#include <ImfHeader.h>

#include <optional>

namespace sparselens {

std::optional<double> render_samples(const Imf::Header &header);

void write_render_samples(Imf::Header &header, int samples);

} // namespace sparselens
