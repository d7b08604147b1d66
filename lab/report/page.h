// The report as one HTML page with embedded pictures, plots, style and script, which opens without a server.
#pragma once

#include "lab/report/row.h"

#include <span>
#include <string>
#include <vector>

namespace sparselens::lab {

struct PagePicture {
    std::string title;
    std::string png; // the bytes of the file
};

struct PageScene {
    std::span<const ReportRow> rows;
    std::vector<std::string> sentences;  // the verdict
    std::vector<std::string> plots;      // SVG files: the ways in use
    std::vector<std::string> more_plots; // all measured ways, on demand
    // All of the same size; the first is the reference, the second is shown beside it.
    std::vector<PagePicture> pictures;
    // The worst 8 x 8 pixels of each row with their surroundings, beside the same part of the reference.
    std::vector<PagePicture> worst;
};

struct Page {
    std::vector<std::string> facts; // machine, command, date: one line each
    std::vector<PageScene> scenes;
};

std::string page_as_html(const Page &page);

} // namespace sparselens::lab
