// Runs steps one at a time and remembers each, so that a report goes on where it stopped.
//
// A step's record (steps/NAME.json in the report's folder) holds what it was: its commands, the contents of the
// programs, the records of its inputs, size and time of the files it was given. While that is unchanged and its
// outputs are there, the step is not run again. Damaged records count as none.
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
    std::string folder; // of the report
    int threads = 0;    // of every program
    int runs = 3;       // of a step that is timed; its times are their medians
    double enough = 3;  // seconds: a step whose runs took longer together is not run again
    std::optional<std::uint64_t> max_memory = {}; // of every program, for reading a file
};

// One a step, in their order.
std::vector<StepTimes> run_steps(std::span<const Step> steps, const RunOptions &options,
                                 const ToolContext &tool);

} // namespace sparselens::lab
