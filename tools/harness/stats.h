// --stats: statistics on the work that a stage left out, as one line of JSON per stage and frame, so that the stages of
// a pipe can share a file. docs/stats.md explains the keys.
#pragma once

#include "deep/cluster.h"
#include "dof/lens/lens_tiles.h"
#include "harness/tool.h"
#include "loading/ldi_cache.h"
#include "plan/plan.h"
#include "view/view.h"

#include <nlohmann/json.hpp>

#include <span>

namespace sparselens {

using Stats = nlohmann::ordered_json;

Stats plan_stats(const Plan &plan, int views_allowed, const Windows &centre);
Stats warp_stats(std::span<const View> views, const Ldi &ldi);
Stats cluster_stats(const LoadedLdi &in, const Clustered &out);
Stats gather_stats(const InputLdi &in, const LensTiles &tiles); // no tiles: nothing was gathered by tiles

// Appends a line with the name of the tool, the frame if there are several, and `fields` to the file that --stats names
// (- for stderr). Does nothing without --stats. Throws Error where the file cannot be written.
void write_stats(const ToolContext &tool, const Stats &fields);

} // namespace sparselens
