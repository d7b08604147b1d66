// The suites of the host: parameters, image effects, memory, threads, messages.
#include "ofx_model.h"

#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <thread>

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

Effect &effect_of(OfxImageEffectHandle handle) { return *reinterpret_cast<Effect *>(handle); }
ParameterSet &set_of(OfxParamSetHandle handle) { return *reinterpret_cast<ParameterSet *>(handle); }
Clip &clip_of(OfxImageClipHandle handle) { return *reinterpret_cast<Clip *>(handle); }

// Parameters

OfxStatus define_parameter(OfxParamSetHandle set, const char *type, const char *name,
                           OfxPropertySetHandle *properties) {
    auto &parameter = set_of(set).parameters[name];
    if (parameter) return kOfxStatErrExists;
    parameter = std::make_unique<Parameter>(Parameter{type});
    set_of(set).order.emplace_back(name);
    if (properties) *properties = parameter->properties.handle();
    return kOfxStatOK;
}
OfxStatus parameter_handle(OfxParamSetHandle set, const char *name, OfxParamHandle *handle,
                           OfxPropertySetHandle *properties) {
    const auto there = set_of(set).parameters.find(name);
    if (there == set_of(set).parameters.end()) return kOfxStatErrUnknown;
    *handle = reinterpret_cast<OfxParamHandle>(there->second.get());
    if (properties) *properties = there->second->properties.handle();
    return kOfxStatOK;
}
OfxStatus set_properties(OfxParamSetHandle set, OfxPropertySetHandle *properties) {
    *properties = set_of(set).properties.handle();
    return kOfxStatOK;
}
OfxStatus parameter_properties(OfxParamHandle handle, OfxPropertySetHandle *properties) {
    *properties = reinterpret_cast<Parameter *>(handle)->properties.handle();
    return kOfxStatOK;
}
OfxStatus value_at(OfxParamHandle handle, OfxTime time, va_list where) {
    Parameter &parameter = *reinterpret_cast<Parameter *>(handle);
    if (parameter.type == kOfxParamTypeString)
        *va_arg(where, char **) = parameter.text.data();
    else if (parameter.type == kOfxParamTypeDouble)
        *va_arg(where, double *) = parameter.number_at(time);
    else
        *va_arg(where, int *) = int(parameter.number_at(time));
    return kOfxStatOK;
}
OfxStatus get_value(OfxParamHandle handle, ...) {
    va_list where;
    va_start(where, handle);
    const OfxStatus status = value_at(handle, 0, where);
    va_end(where);
    return status;
}
OfxStatus get_value_at_time(OfxParamHandle handle, OfxTime time, ...) {
    va_list where;
    va_start(where, time);
    const OfxStatus status = value_at(handle, time, where);
    va_end(where);
    return status;
}

const OfxParameterSuiteV1 *parameter_suite() {
    static OfxParameterSuiteV1 suite{};
    suite.paramDefine = define_parameter;
    suite.paramGetHandle = parameter_handle;
    suite.paramSetGetPropertySet = set_properties;
    suite.paramGetPropertySet = parameter_properties;
    suite.paramGetValue = get_value;
    suite.paramGetValueAtTime = get_value_at_time;
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
OfxStatus clip_properties(OfxImageClipHandle clip, OfxPropertySetHandle *properties) {
    *properties = clip_of(clip).properties.handle();
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
    suite.clipGetPropertySet = clip_properties;
    suite.clipGetImage = clip_image;
    suite.clipReleaseImage = release_image;
    suite.clipGetRegionOfDefinition = clip_region;
    suite.abort = abort_asked;
    return &suite;
}

// Memory, threads, messages

OfxStatus allocate(void *, std::size_t bytes, void **data) {
    *data = std::malloc(bytes);
    return *data ? kOfxStatOK : kOfxStatErrMemory;
}
OfxStatus give_back(void *data) {
    std::free(data);
    return kOfxStatOK;
}
const OfxMemorySuiteV1 memory_suite{allocate, give_back};

OfxStatus on_threads(OfxThreadFunctionV1 work, unsigned count, void *argument) {
    std::vector<std::thread> threads;
    for (unsigned i = 0; i < count; ++i) threads.emplace_back(work, i, count, argument);
    for (std::thread &thread : threads) thread.join();
    return kOfxStatOK;
}
const OfxMultiThreadSuiteV1 *thread_suite() {
    static OfxMultiThreadSuiteV1 suite{};
    suite.multiThread = on_threads;
    return &suite;
}

OfxStatus show(const char *format, va_list arguments) {
    char text[4096];
    std::vsnprintf(text, sizeof text, format, arguments);
    const std::lock_guard lock(messages().mutex);
    messages().last = text;
    return kOfxStatOK;
}
OfxStatus show_message(void *, const char *, const char *, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const OfxStatus status = show(format, arguments);
    va_end(arguments);
    return status;
}
OfxStatus clear_message(void *) {
    const std::lock_guard lock(messages().mutex);
    messages().last.clear();
    return kOfxStatOK;
}
const OfxMessageSuiteV1 message_suite{show_message};
const OfxMessageSuiteV2 lasting_suite{show_message, show_message, clear_message};

const void *fetch(OfxPropertySetHandle, const char *name, int version) {
    const auto is = [&](const char *suite, int of) { return std::strcmp(name, suite) == 0 && version == of; };
    if (is(kOfxPropertySuite, 1)) return property_suite();
    if (is(kOfxParameterSuite, 1)) return parameter_suite();
    if (is(kOfxImageEffectSuite, 1)) return effect_suite();
    if (is(kOfxMemorySuite, 1)) return &memory_suite;
    if (is(kOfxMultiThreadSuite, 1)) return thread_suite();
    if (is(kOfxMessageSuite, 1)) return &message_suite;
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
