#include "harness/examples.h"

#include <CLI/CLI.hpp>

namespace sparselens {

namespace {
const std::string heading = "Examples:\n";
}

void add_examples(CLI::App &app, std::initializer_list<Example> examples) {
    std::string text = heading;
    for (const auto &[purpose, command] : examples)
        text += std::string("  ") + purpose + ":\n      " + command + "\n";
    app.footer(text);
#if CLI11_VERSION_MAJOR > 2 || CLI11_VERSION_MINOR >= 6
    app.get_formatter()->enable_footer_formatting(false); // the formatter would join lines
#endif
}

std::string examples_text(const CLI::App &app) {
    const std::string text = app.get_footer();
    return text.starts_with(heading) ? text.substr(heading.size()) : "";
}

} // namespace sparselens
