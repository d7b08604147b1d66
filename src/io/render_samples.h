// How many samples a pixel a picture was rendered with, where its header says so: `sparselens:samples` (dof-trace), or
// `cycles.LAYER.samples` (Blender's Cycles; the most of its layers, as adaptive sampling may take fewer).
#pragma once

#include <ImfHeader.h>

#include <optional>

namespace sparselens {

std::optional<double> render_samples(const Imf::Header &header);

void write_render_samples(Imf::Header &header, int samples);

} // namespace sparselens
