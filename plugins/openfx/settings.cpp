#include "settings.h"

#include "host.h"
#include "parameter_table.h"

#include <array>
#include <charconv>
#include <vector>

namespace sparselens_ofx {

namespace {

class Values {
public:
    Values(OfxImageEffectHandle effect, double time) : all_(parameters_of(effect)), time_(time) {}

    // A value that the host does not give is `otherwise`.
    template <typename Value>
    Value at(const std::string &name, Value otherwise) const {
        OfxParamHandle parameter = nullptr;
        Value value = otherwise;
        if (suites().parameters->paramGetHandle(all_, name.c_str(), &parameter, nullptr) != kOfxStatOK ||
            suites().parameters->paramGetValueAtTime(parameter, time_, &value) != kOfxStatOK)
            return otherwise;
        return value;
    }
    std::string text(const std::string &name) const {
        const char *value = at<char *>(name, nullptr);
        return value ? value : "";
    }

private:
    OfxParamSetHandle all_;
    double time_;
};

// The shortest text that is this number.
std::string text_of(double number) {
    std::array<char, 64> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), number).ptr;
    return {text.data(), end};
}

std::string pair_in(const Values &values, const ParameterRow &row) {
    const double x = values.at<double>(name_x(row), 0), y = values.at<double>(name_y(row), 0);
    return x == 0 && y == 0 ? std::string() : text_of(x) + "," + text_of(y);
}

std::string word_in(const Values &values, const ParameterRow &row) {
    const std::vector<std::string> words = words_of(row);
    const int option = values.at<int>(row.name, 0);
    return option > 0 && std::size_t(option) <= words.size() ? words[std::size_t(option) - 1] : std::string();
}

// The value as dof-gather reads it; "" if it says nothing.
std::string value_in(const Values &values, const ParameterRow &row) {
    switch (row.kind) {
    case ParameterKind::flag: return values.at<int>(row.name, 0) != 0 ? "true" : "";
    case ParameterKind::whole: {
        const int whole = values.at<int>(row.name, int(row.nothing));
        return whole == int(row.nothing) ? "" : std::to_string(whole);
    }
    case ParameterKind::number: {
        const double number = values.at<double>(row.name, row.nothing);
        return number == row.nothing ? "" : text_of(number);
    }
    case ParameterKind::pair: return pair_in(values, row);
    case ParameterKind::choice: return word_in(values, row);
    case ParameterKind::text:
    case ParameterKind::file: break;
    }
    return values.text(row.name);
}

} // namespace

std::map<std::string, std::string> settings_at(OfxImageEffectHandle effect, double time) {
    const Values values(effect, time);
    std::map<std::string, std::string> settings;
    for (const ParameterRow &row : parameter_table()) {
        const std::string value = value_in(values, row);
        if (!value.empty()) settings[setting_of(row.name)] = value;
    }
    for (const ParameterRow &row : parameter_table())
        if (*row.needs && !settings.contains(setting_of(row.needs))) settings.erase(setting_of(row.name));
    return settings;
}

std::string text_at(OfxImageEffectHandle effect, const char *parameter, double time) {
    return Values(effect, time).text(parameter);
}

int whole_at(OfxImageEffectHandle effect, const char *parameter, double time) {
    return Values(effect, time).at<int>(parameter, 0);
}

} // namespace sparselens_ofx
