// Options whose values are words.
#pragma once

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <string>
#include <vector>

namespace sparselens {

// Turns each word into the number of its value, which CLI11 reads into an enum or a bool. Everything else, even a
// number, is a usage error that lists the words.
template <typename Value>
CLI::Validator words(const std::map<std::string, Value> &values) {
    const auto look_up = [values](std::string &text) -> std::string {
        const auto found = values.find(text);
        if (found == values.end()) {
            std::vector<std::string> all;
            for (const auto &[word, value] : values) all.push_back(word);
            return fmt::format("must be one of {}, not '{}'", fmt::join(all, ", "), text);
        }
        text = fmt::to_string(static_cast<int>(found->second));
        return {};
    };
    return CLI::Validator(look_up, "");
}

} // namespace sparselens
