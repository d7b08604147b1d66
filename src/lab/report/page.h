// The report as one HTML page that opens without a server: pictures, plots, style and script are within it.
#pragma once

#include "lab/report/row.h"

#include <span>
#include <string>
#include <vector>

namespace sparselens::lab {

struct PagePicture {
    std::string title;
    std::string png; // the file's bytes
};

struct PageScene {
    std::span<const ReportRow> rows;
    std::vector<std::string> sentences; // the verdict
    std::vector<std::string> plots;     // SVG files
    std::vector<PagePicture> pictures;  // of one size; the first is the reference, the second shown beside it
};

struct Page {
    std::vector<std::string> facts; // machine, command, date: a line each
    std::vector<PageScene> scenes;
};

std::string page_as_html(const Page &page);

} // namespace sparselens::lab
