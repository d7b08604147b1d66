// The work behind a report: steps that run programs, each after those whose files it reads.
#pragma once

#include "lab/report/row.h"

#include <optional>
#include <string>
#include <vector>

namespace sparselens::lab {

struct StepCommand {
    Stage stage;
    std::vector<std::string>
        words; // program first, as it lies in the folder of the tools; paths relative to the report
};

struct Step {
    std::string name{}; // unique, fit for a file name; may hold /
    std::vector<StepCommand> commands{};
    std::vector<std::size_t> inputs{};  // of earlier steps
    std::vector<std::string> given{};   // files read that no step makes
    std::vector<std::string> outputs{}; // files that are there afterwards
    std::string fresh{};                // a folder emptied beforehand; empty: none
    bool scratch = false;               // that folder is needed between the commands only
    // Pictures that a dof-trace rendered into this folder beside what is wanted: their seconds are taken off.
    std::string traced{};
    std::vector<std::string> uncounted{};
    bool timed = true; // else it is run once: nobody asks how long it took
    double weight = 1; // seconds it might take: for the time left alone
};

// What running a step gave: medians.
struct StepTimes {
    std::array<double, 5> seconds{}; // by Stage
    double peak_mb = 0;
    int runs = 0;
};

class StepList {
public:
    // The step's index; one of a name is kept once.
    std::size_t add(Step step);
    const std::vector<Step> &steps() const { return steps_; }

private:
    std::vector<Step> steps_;
};

} // namespace sparselens::lab
