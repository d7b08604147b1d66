// Notices about files, when they are read and written.
#pragma once

#include "chain/notices.h"
#include "io/open_ldi.h"
#include "lens/lens_looks.h"

#include <span>
#include <string>
#include <vector>

namespace sparselens {

// The notes and warnings of a file's reader.
void tell_reading(const Tell &tell, const std::string &path, const std::vector<std::string> &notes,
                  const std::vector<std::string> &warnings);

// What happens to each layer, in the order of their first channels, as in the table of docs/file-format.md.
std::vector<std::string> layer_notes(std::span<const Channel> channels);
void tell_layers(const Tell &tell, const std::string &path, std::span<const Channel> channels);

// The notes and warnings of an LDI, whether it has per-channel alpha, and its invalid values.
void tell_samples(const Tell &tell, const OpenedLdi &in);

// What the file states about its camera, and in which attributes.
void tell_camera(const Tell &tell, const std::string &path, const Camera &camera);

// The findings of checks in pictures (deep/checks/view_warnings.h).
void tell_warnings(const Tell &tell, const std::vector<std::string> &warnings);

// How much overscan the blur needs, in pixels of `across` sub-pixels. It warns if there is too little and a light at
// the border would have its disc cut.
void tell_border_reach(const Tell &tell, const std::string &path, const Ldi &ldi, const ThinLens &lens,
                       int across, const LensLooks &looks);

// All send a notice only if there is something to report. `speckles`: how many were settled (view/speckles.h).
// `clamped` is the result of write_flat_exr or write_ldi.
void tell_clamped(const Tell &tell, const std::string &path, std::size_t clamped);
void tell_speckles(const Tell &tell, const std::string &path, std::size_t speckles);
void tell_invalid_values(const Tell &tell, const std::string &path, const InvalidValues &bad);

} // namespace sparselens
