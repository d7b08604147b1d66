// Options whose values are words.
#pragma once

#include <CLI/CLI.hpp>

#include <map>
#include <string>

namespace sparselens {

// Turns each word into its value's number, which CLI11 reads into an enum or a bool; anything else, numbers
// included, is a usage error that names the words.
template <typename Value>
CLI::Validator words(const std::map<std::string, Value> &values) {
    const auto look_up = [values](std::string &text) -> std::string {
        const auto found = values.find(text);
        if (found == values.end()) {
            std::string all;
            for (const auto &[word, value] : values) all += (all.empty() ? "" : "|") + word;
            return "'" + text + "' is none of " + all;
        }
        text = std::to_string(static_cast<int>(found->second));
        return {};
    };
    return CLI::Validator(look_up, "");
}

} // namespace sparselens
