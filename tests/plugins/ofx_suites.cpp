// The suites of the host: properties, parameters, image effects, messages. They have what the effect calls.
#include "ofx_model.h"

#include <cstdarg>
#include <cstring>
#include <type_traits>

namespace ofx_host {

double Parameter::number_at(double time) const {
    if (keys.empty()) {
        const Value value =
            properties.has(kOfxParamPropDefault) ? properties.values.at(kOfxParamPropDefault)[0] : Value(0);
        return std::holds_alternative<int>(value) ? std::get<int>(value) : std::get<double>(value);
    }
    const auto after = keys.lower_bound(time);
    if (after == keys.end()) return keys.rbegin()->second;
    if (after == keys.begin() || after->first == time) return after->second;
    const auto before = std::prev(after);
    const double share = (time - before->first) / (after->first - before->first);
    return before->second + share * (after->second - before->second);
}

unsigned char *Image::pixel(int x, int y) {
    const int row = downwards ? height - 1 - (y - y1) : y - y1;
    return &memory[(std::size_t(row) * std::size_t(width) + std::size_t(x - x1)) * pixel_bytes];
}

Messages &messages() {
    static Messages all;
    return all;
}

namespace {

Properties &properties_of(OfxPropertySetHandle handle) { return *reinterpret_cast<Properties *>(handle); }
Effect &effect_of(OfxImageEffectHandle handle) { return *reinterpret_cast<Effect *>(handle); }
ParameterSet &set_of(OfxParamSetHandle handle) { return *reinterpret_cast<ParameterSet *>(handle); }
Clip &clip_of(OfxImageClipHandle handle) { return *reinterpret_cast<Clip *>(handle); }

// Properties

template <typename T, typename Given>
OfxStatus set_one(OfxPropertySetHandle set, const char *name, int index, Given value) {
    properties_of(set).set<T>(name, T(value), index);
    return kOfxStatOK;
}
template <typename T, typename Given>
OfxStatus get_one(OfxPropertySetHandle set, const char *name, int index, Given *value) {
    auto &values = properties_of(set).values;
    const auto there = values.find(name);
    if (there == values.end() || std::size_t(index) >= there->second.size()) return kOfxStatErrUnknown;
    T *found = std::get_if<T>(&there->second[std::size_t(index)]);
    if (!found) return kOfxStatErrUnknown;
    if constexpr (std::is_same_v<T, std::string>)
        *value = found->data();
    else
        *value = *found;
    return kOfxStatOK;
}

const OfxPropertySuiteV1 *property_suite() {
    static OfxPropertySuiteV1 suite{};
    suite.propSetString = set_one<std::string, const char *>;
    suite.propSetDouble = set_one<double, double>;
    suite.propSetInt = set_one<int, int>;
    suite.propGetPointer = get_one<void *, void *>;
    suite.propGetString = get_one<std::string, char *>;
    suite.propGetDouble = get_one<double, double>;
    suite.propGetInt = get_one<int, int>;
    return &suite;
}

// Parameters

OfxStatus define_parameter(OfxParamSetHandle set, const char *type, const char *name,
                           OfxPropertySetHandle *properties) {
    auto &parameter = set_of(set).parameters[name];
    if (parameter) return kOfxStatErrExists;
    parameter = std::make_unique<Parameter>(Parameter{type});
    set_of(set).order.emplace_back(name);
    *properties = parameter->properties.handle();
    return kOfxStatOK;
}
OfxStatus parameter_handle(OfxParamSetHandle set, const char *name, OfxParamHandle *handle,
                           OfxPropertySetHandle *) {
    const auto there = set_of(set).parameters.find(name);
    if (there == set_of(set).parameters.end()) return kOfxStatErrUnknown;
    *handle = reinterpret_cast<OfxParamHandle>(there->second.get());
    return kOfxStatOK;
}
OfxStatus value_at_time(OfxParamHandle handle, OfxTime time, ...) {
    Parameter &parameter = *reinterpret_cast<Parameter *>(handle);
    va_list where;
    va_start(where, time);
    if (parameter.type == kOfxParamTypeString)
        *va_arg(where, char **) = parameter.text.data();
    else if (parameter.type == kOfxParamTypeDouble)
        *va_arg(where, double *) = parameter.number_at(time);
    else
        *va_arg(where, int *) = int(parameter.number_at(time));
    va_end(where);
    return kOfxStatOK;
}

const OfxParameterSuiteV1 *parameter_suite() {
    static OfxParameterSuiteV1 suite{};
    suite.paramDefine = define_parameter;
    suite.paramGetHandle = parameter_handle;
    suite.paramGetValueAtTime = value_at_time;
    return &suite;
}

// Image effects

OfxStatus effect_properties(OfxImageEffectHandle effect, OfxPropertySetHandle *properties) {
    *properties = effect_of(effect).properties.handle();
    return kOfxStatOK;
}
OfxStatus effect_parameters(OfxImageEffectHandle effect, OfxParamSetHandle *parameters) {
    *parameters = reinterpret_cast<OfxParamSetHandle>(&effect_of(effect).parameters);
    return kOfxStatOK;
}
OfxStatus define_clip(OfxImageEffectHandle effect, const char *name, OfxPropertySetHandle *properties) {
    auto &clip = effect_of(effect).clips[name];
    clip = std::make_unique<Clip>();
    *properties = clip->properties.handle();
    return kOfxStatOK;
}
OfxStatus clip_handle(OfxImageEffectHandle effect, const char *name, OfxImageClipHandle *handle,
                      OfxPropertySetHandle *properties) {
    const auto there = effect_of(effect).clips.find(name);
    if (there == effect_of(effect).clips.end()) return kOfxStatErrBadHandle;
    *handle = reinterpret_cast<OfxImageClipHandle>(there->second.get());
    if (properties) *properties = there->second->properties.handle();
    return kOfxStatOK;
}
OfxStatus clip_image(OfxImageClipHandle clip, OfxTime, const OfxRectD *, OfxPropertySetHandle *image) {
    if (!clip_of(clip).image) return kOfxStatFailed;
    *image = clip_of(clip).image->properties.handle();
    return kOfxStatOK;
}
OfxStatus release_image(OfxPropertySetHandle image) { return image ? kOfxStatOK : kOfxStatErrBadHandle; }
OfxStatus clip_region(OfxImageClipHandle clip, OfxTime, OfxRectD *region) {
    const auto &image = clip_of(clip).image;
    if (!image) return kOfxStatFailed;
    *region = {double(image->x1), double(image->y1), double(image->x1 + image->width),
               double(image->y1 + image->height)};
    return kOfxStatOK;
}
int abort_asked(OfxImageEffectHandle) { return 0; }

const OfxImageEffectSuiteV1 *effect_suite() {
    static OfxImageEffectSuiteV1 suite{};
    suite.getPropertySet = effect_properties;
    suite.getParamSet = effect_parameters;
    suite.clipDefine = define_clip;
    suite.clipGetHandle = clip_handle;
    suite.clipGetImage = clip_image;
    suite.clipReleaseImage = release_image;
    suite.clipGetRegionOfDefinition = clip_region;
    suite.abort = abort_asked;
    return &suite;
}

// Messages

OfxStatus show_message(void *, const char *, const char *, const char *format, ...) {
    char text[4096];
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    const std::lock_guard lock(messages().mutex);
    messages().last = text;
    return kOfxStatOK;
}
OfxStatus clear_message(void *) {
    const std::lock_guard lock(messages().mutex);
    messages().last.clear();
    return kOfxStatOK;
}
const OfxMessageSuiteV2 lasting_suite{show_message, show_message, clear_message};

const void *fetch(OfxPropertySetHandle, const char *name, int version) {
    const auto is = [&](const char *suite, int of) { return std::strcmp(name, suite) == 0 && version == of; };
    if (is(kOfxPropertySuite, 1)) return property_suite();
    if (is(kOfxParameterSuite, 1)) return parameter_suite();
    if (is(kOfxImageEffectSuite, 1)) return effect_suite();
    if (is(kOfxMessageSuite, 2)) return &lasting_suite;
    return nullptr;
}

} // namespace

OfxHost *make_host(Properties &properties) {
    static OfxHost host{};
    host = {properties.handle(), fetch};
    return &host;
}

} // namespace ofx_host
