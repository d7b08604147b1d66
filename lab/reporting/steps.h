// The work behind a report: steps that run programs, each after the steps whose files it reads.
#pragma once

#include "lab/report/row.h"

#include <optional>
#include <string>
#include <vector>

namespace sparselens::lab {

struct StepCommand {
    Stage stage;
    // the program, by its name in the folder of the tools, and arguments; paths are relative to the report's folder
    std::vector<std::string> words;
};

struct Step {
    std::string name{}; // unique, fit for a file name; may hold /
    std::vector<StepCommand> commands{};
    std::vector<std::size_t> inputs{};  // indices of earlier steps
    std::vector<std::string> given{};   // input files that no step makes
    std::vector<std::string> outputs{}; // files that exist afterwards
    std::string fresh{};                // a folder that is emptied first; empty: none
    bool scratch = false;               // that folder is needed only between the commands
    // Pictures that dof-trace rendered into this folder in addition; their seconds are subtracted.
    std::string traced{};
    std::vector<std::string> uncounted{};
    bool timed = true; // false: run once, because its time is not needed
    double weight = 1; // estimated seconds, only for the displayed time left
};

// The times of a step, as medians.
struct StepTimes {
    std::array<double, 5> seconds{}; // by Stage
    double peak_mb = 0;
    int runs = 0;
};

class StepList {
public:
    // Returns the index of the step; a step of the same name is kept once.
    std::size_t add(Step step);
    const std::vector<Step> &steps() const { return steps_; }

private:
    std::vector<Step> steps_;
};

} // namespace sparselens::lab
