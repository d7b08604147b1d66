// The pictures of a scene that dof-trace writes. Each has random numbers of its own: its noise does not depend on what
// else is rendered.
#pragma once

#include "lab/trace/tracer.h"
#include "lab/tracing/trace_options.h"
#include "lab/tracing/trace_outputs.h"

#include <vector>

namespace sparselens::lab {

struct TraceJob {
    const TraceOptions &options;
    const Tracer &tracer;
    const RenderSettings &settings;
    TraceOutputs &outputs;
    Progress &progress;
};

// The views of --plan, of each the pixels that it asks for. Their lens points. Error: it was made for a picture of
// another size.
std::vector<Imath::V2d> trace_plan(const TraceJob &job);

// The centre view and --views from the rim of the lens, whose lens points it returns.
std::vector<Imath::V2d> trace_rim(const TraceJob &job);

// --lens-views over the whole lens.
void trace_lens(const TraceJob &job);

// By distributed ray tracing, where --reference asks for it.
void trace_reference(const TraceJob &job);

// --deep, each.
void trace_deep(const TraceJob &job);

} // namespace sparselens::lab
