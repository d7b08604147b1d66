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
    const RenderSettings &settings; // for the picture: the reference, and views that are averaged
    const RenderSettings &view;     // for the other views and deep pictures, which may have finer pixels
    int view_samples;               // per pixel of those
    TraceOutputs &outputs;
    Progress &progress;
};

// Renders the pixels that --plan asks for in each of its views, and returns their lens points. Throws Error if the plan
// was made for a picture of another size.
std::vector<Imath::V2d> trace_plan(const TraceJob &job);

// Renders the centre view and --views views from the rim of the lens, at each of --moments, and returns the lens points
// of the latter.
std::vector<Imath::V2d> trace_rim(const TraceJob &job);

// Renders --lens-views views from the whole lens.
void trace_lens(const TraceJob &job);

// Renders the reference by distributed ray tracing, if --reference asks for it.
void trace_reference(const TraceJob &job);

// Renders two halves of --halves rays each in the same way as the reference, with independent noise.
void trace_halves(const TraceJob &job);

// Renders the deep picture of each --deep.
void trace_deep(const TraceJob &job);

} // namespace sparselens::lab
