// The data of an OpenFX host: effects, with their properties, parameters, and clips with images. A handle is a pointer
// to one of these.
#pragma once

#include "../../plugins/openfx/ofx.h"

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

namespace ofx_host {

using Value = std::variant<int, double, std::string, void *>;

struct Properties {
    std::map<std::string, std::vector<Value>> values = {};

    template <typename T>
    void set(const std::string &name, T value, int index = 0) {
        auto &all = values[name];
        if (all.size() <= std::size_t(index)) all.resize(std::size_t(index) + 1);
        all[std::size_t(index)] = Value(std::move(value));
    }
    template <typename T>
    T get(const std::string &name, int index = 0) const {
        return std::get<T>(values.at(name).at(std::size_t(index)));
    }
    bool has(const std::string &name) const { return values.contains(name); }
    OfxPropertySetHandle handle() { return reinterpret_cast<OfxPropertySetHandle>(this); }
};

struct Parameter {
    std::string type = {};
    Properties properties = {};
    std::map<double, double> keys = {}; // of a number, by time; empty: the default
    std::string text = {};

    double number_at(double time) const; // between two keys on a line
};

struct ParameterSet {
    std::map<std::string, std::unique_ptr<Parameter>> parameters = {};
    std::vector<std::string> order = {};
};

// Rows go upwards from the lower one, in memory upwards or downwards.
struct Image {
    Properties properties = {};
    int x1 = 0, y1 = 0, width = 0, height = 0;
    std::size_t pixel_bytes = 0;
    std::vector<unsigned char> memory = {};
    bool downwards = false;

    unsigned char *pixel(int x, int y);
};

struct Clip {
    Properties properties = {};
    std::shared_ptr<Image> image = {}; // null: not connected
};

struct Effect {
    Properties properties = {};
    ParameterSet parameters = {};
    std::map<std::string, std::unique_ptr<Clip>> clips = {};
    OfxImageEffectHandle handle() { return reinterpret_cast<OfxImageEffectHandle>(this); }
};

// The messages that the plug-in has shown since the last clear.
struct Messages {
    std::mutex mutex = {};
    std::string last = {};
};
Messages &messages();

// The host with its suites. `properties` says what it can do.
OfxHost *make_host(Properties &properties);

} // namespace ofx_host
