// Runs steps one at a time and records each, so that a report continues where it stopped.
//
// The record of a step (steps/NAME.json in the folder of the report) holds its commands, the contents of the programs,
// the records of its inputs, and the sizes and times of its given files. While these are unchanged and its outputs
// exist, the step is not run again. A damaged record counts as missing.
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
    std::string tools;                            // folder of the programs
    std::string folder;                           // folder of the report
    int threads = 0;                              // for every program
    int runs = 3;                                 // of a timed step; its times are medians
    double enough = 3;                            // seconds; a step is not run again after this total
    std::optional<std::uint64_t> max_memory = {}; // of every program, for reading a file
};

// The times of the steps, in order.
std::vector<StepTimes> run_steps(std::span<const Step> steps, const RunOptions &options,
                                 const ToolContext &tool);

} // namespace sparselens::lab
