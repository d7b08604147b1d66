// Options that only one value of another option uses: given with any other value they would have no effect, so they are
// refused.
#pragma once

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <span>
#include <string>
#include <string_view>

namespace sparselens {

struct OnlyWith {
    const char *option, *needs, *value; // `option` works with `needs` `value` only
};

// Throws CLI::ValidationError where a given option of the table does not go with the chosen value of `needs`.
inline void refuse_ignored(const CLI::App &parsed, std::span<const OnlyWith> table, std::string_view needs,
                           std::string_view chosen) {
    for (const auto &[option, needed, value] : table)
        if (needs == needed && chosen != value && parsed.get_option(option)->count() > 0)
            throw CLI::ValidationError(option, fmt::format("works with {} {} only", needed, value));
}

} // namespace sparselens
