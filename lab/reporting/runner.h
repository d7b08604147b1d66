// Runs steps one at a time and records each, so that a report continues where it stopped.
//
// The record of a step (steps/NAME.json in the folder of the report) holds its commands, the contents of the programs,
// the records of its inputs, and the sizes and times of the files that it was given. While these are unchanged and its
// outputs exist, the step is not run again. A damaged record counts as missing.
#pragma once

#include "harness/tool.h"
#include "lab/reporting/steps.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace sparselens::lab {

struct RunOptions {
    std::string tools;  // folder of the programs
    std::string folder; // that of the report
    int threads = 0;    // for every program
    int runs = 3;       // of a timed step, whose times are medians
    double enough = 3;  // seconds; a step whose runs took longer in total is not run again
    std::optional<std::uint64_t> max_memory = {}; // for every program, for reading a file
};

// The times of the steps, in their order.
std::vector<StepTimes> run_steps(std::span<const Step> steps, const RunOptions &options,
                                 const ToolContext &tool);

} // namespace sparselens::lab
