// The pictures of a scene that dof-trace writes. Each has its own random numbers, so its noise does not depend on the
// other pictures.
#pragma once

#include "lab/trace/tracer.h"
#include "lab/tracing/trace_options.h"
#include "lab/tracing/trace_outputs.h"

#include <vector>

namespace sparselens::lab {

struct TraceJob {
    const TraceOptions &options;
    const Tracer &tracer;
    const RenderSettings &settings; // of the picture: the reference, and views that are to be averaged
    const RenderSettings &view;     // of the other views and deep pictures, whose pixels may be finer,
    int view_samples;               // and which have so many samples in each
    TraceOutputs &outputs;
    Progress &progress;
};

// Renders the pixels that --plan asks for in each of its views, and returns their lens points. Throws Error where the
// plan was made for a picture of another size.
std::vector<Imath::V2d> trace_plan(const TraceJob &job);

// Renders the centre view and --views views from the rim of the lens, and returns the lens points of the latter.
std::vector<Imath::V2d> trace_rim(const TraceJob &job);

// Renders --lens-views views from the whole lens.
void trace_lens(const TraceJob &job);

// Renders the reference by distributed ray tracing, if --reference asks for it.
void trace_reference(const TraceJob &job);

// Renders two halves of --halves rays each as the reference is, without noise in common.
void trace_halves(const TraceJob &job);

// Renders the deep picture of each --deep.
void trace_deep(const TraceJob &job);

} // namespace sparselens::lab
