// The command line of dof-finish.
#pragma once

#include "harness/commands/cli.h"
#include "harness/history.h"
#include "options/picture_options.h"

#include <optional>
#include <string>
#include <vector>

namespace sparselens {

enum class ShowFinished { picture, error, trust };

struct FinishCommand {
    std::string gathered, output;
    std::vector<std::string> renders, denoised, others;
    std::vector<double> samples; // of each render; empty: from their headers
    int neighbours = 0;          // frames before and after that are used
    std::optional<double> goal;  // dB
    std::string ask;             // the file for a mask of samples; empty: none
    double rays = 0; // for `ask`: per pixel, those of the renders included; 0: as many as `goal` takes
    ShowFinished show = ShowFinished::picture;
    ColourOptions colour; // for the output
    std::optional<PixelType> type;
    AskedCompression compression;
    HistoryOptions history;
};

// `options` must not move until the command line is parsed.
void add_finish_options(CLI::App &app, FinishCommand &options);

} // namespace sparselens
