#include "host.h"

#include <cstdio>

namespace sparselens_ofx {

namespace {

Suites the_suites;

template <typename Suite>
const Suite *fetched(OfxHost *host, const char *name, int version) {
    return static_cast<const Suite *>(host->fetchSuite(host->host, name, version));
}

// What a function of the suite of properties gives; `otherwise` if it fails.
template <typename T>
T value_in(OfxStatus (*get)(OfxPropertySetHandle, const char *, int, T *), OfxPropertySetHandle set,
           const char *name, int index, T otherwise) {
    T value = otherwise;
    return set && get(set, name, index, &value) == kOfxStatOK ? value : otherwise;
}

} // namespace

const Suites &suites() { return the_suites; }

bool fetch_suites(OfxHost *host) {
    if (!host || !host->fetchSuite) return false;
    the_suites = {fetched<OfxPropertySuiteV1>(host, kOfxPropertySuite, 1),
                  fetched<OfxParameterSuiteV1>(host, kOfxParameterSuite, 1),
                  fetched<OfxImageEffectSuiteV1>(host, kOfxImageEffectSuite, 1),
                  fetched<OfxMessageSuiteV1>(host, kOfxMessageSuite, 1),
                  fetched<OfxMessageSuiteV2>(host, kOfxMessageSuite, 2),
                  host->host};
    return the_suites.properties && the_suites.parameters && the_suites.effects;
}

std::string text_in(OfxPropertySetHandle set, const char *name, const std::string &otherwise) {
    const char *value = value_in<char *>(suites().properties->propGetString, set, name, 0, nullptr);
    return value ? value : otherwise;
}

int whole_in(OfxPropertySetHandle set, const char *name, int index, int otherwise) {
    return value_in(suites().properties->propGetInt, set, name, index, otherwise);
}

double number_in(OfxPropertySetHandle set, const char *name, int index, double otherwise) {
    return value_in(suites().properties->propGetDouble, set, name, index, otherwise);
}

void *pointer_in(OfxPropertySetHandle set, const char *name) {
    return value_in<void *>(suites().properties->propGetPointer, set, name, 0, nullptr);
}

void set(OfxPropertySetHandle set, const char *name, const std::string &value, int index) {
    if (set) suites().properties->propSetString(set, name, index, value.c_str());
}
void set(OfxPropertySetHandle set, const char *name, int value, int index) {
    if (set) suites().properties->propSetInt(set, name, index, value);
}
void set(OfxPropertySetHandle set, const char *name, double value, int index) {
    if (set) suites().properties->propSetDouble(set, name, index, value);
}

OfxPropertySetHandle properties_of(OfxImageEffectHandle effect) {
    OfxPropertySetHandle properties = nullptr;
    if (suites().effects->getPropertySet(effect, &properties) != kOfxStatOK || !properties)
        throw HostError("the host gives no properties of the effect");
    return properties;
}

OfxParamSetHandle parameters_of(OfxImageEffectHandle effect) {
    OfxParamSetHandle parameters = nullptr;
    if (suites().effects->getParamSet(effect, &parameters) != kOfxStatOK || !parameters)
        throw HostError("the host gives no parameters of the effect");
    return parameters;
}

void show_error(OfxImageEffectHandle effect, const std::string &why) {
    const Suites &host = suites();
    auto show = host.messages ? host.messages->message : nullptr;
    if (host.lasting && host.lasting->setPersistentMessage) show = host.lasting->setPersistentMessage;
    if (show) show(effect, kOfxMessageError, "sparselens", "%s", why.c_str());
    if (whole_in(host.host, kOfxImageEffectHostPropIsBackground, 0, 0) != 0)
        std::fprintf(stderr, "sparselens: %s\n", why.c_str());
}

void clear_error(OfxImageEffectHandle effect) {
    const Suites &host = suites();
    if (host.lasting && host.lasting->clearPersistentMessage) host.lasting->clearPersistentMessage(effect);
}

} // namespace sparselens_ofx
