// An LDI from a file, ready for use: depth is planar, invalid values are repaired, samples are tidy, and camera and
// lens come from the file, overridden by the user's values.
#pragma once

#include "../deep/ldi.h"
#include "../deep/sanitize.h"
#include "../view/view.h"
#include "exr/exr_deep.h"
#include "open_view.h"

#include <ImfHeader.h>

#include <cstddef>
#include <functional>
#include <string>
#include <variant>

namespace sparselens {

// How the samples of a file are held.
struct AllSamples {};   // all
struct FewerSamples {}; // the result of a ReduceSamples
using SamplesHeld = std::variant<AllSamples, FewerSamples,
                                 PackedRows>; // PackedRows: all samples, packed; `ldi` is then empty

struct OpenedLdi : OpenedFile {
    std::string name;          // of the file, for messages
    Ldi ldi;                   // tidy
    std::size_t invisible = 0; // samples of the file that tidy() removed: they show nothing, or were merged
    std::size_t samples_read = 0; // tidy ones; more than `ldi` has if they were reduced
    SamplesHeld held = AllSamples{};
    bool deep = true;                // whether the file is deep; else it is flat with depth
    bool coverage_by_colour = false; // AR, AG and AB differ in the file (deep/channel_alpha.h)

    // Throws UsageError if a value of the lens is unknown (see resolve_lens.h).
    ThinLens lens() const { return resolve_lens(camera, ldi.windows); }
    bool reduced() const { return !std::holds_alternative<AllSamples>(held); }
};

// Opens any deep EXR, a flat one with depth, or a photograph with a depth, which is a disparity unless it is an EXR file
// (io/photograph.h); `-` is standard input. Throws Error if most of its depths are invalid (see sanitize()),
// UsageError if its depth is the length of the ray and the focal length is unknown.
OpenedLdi open_ldi(const std::string &path, const OpenOptions &options = {});

// Replaces the samples of some rows, which are tidy, by fewer; windows and channels stay. Several threads call it at
// the same time.
using ReduceSamples = std::function<Ldi(Ldi rows)>;
// Chooses the ReduceSamples of a file, once; empty: all samples are needed. `rows` are some of its rows.
using ChooseSamples =
    std::function<ReduceSamples(const Imf::Header &header, const Camera &camera, const Ldi &rows)>;

// The same with less memory, for callers that need fewer samples. All samples are read if `choose` says so, if the
// picture cannot be read a few rows at a time (see read_ldi()), or if values are invalid, because repairing them takes
// the pixels around.
OpenedLdi open_ldi(const std::string &path, const OpenOptions &options, const ChooseSamples &choose);

// The same for a deep picture that is already in memory; `path` is for messages.
OpenedLdi prepare_ldi(LdiFile file, const std::string &path, const OpenOptions &options = {});

} // namespace sparselens
