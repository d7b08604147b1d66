// The suites of the host, and the properties that it gives.
#pragma once

#include "ofx.h"

#include <stdexcept>
#include <string>

namespace sparselens_ofx {

struct Suites {
    const OfxPropertySuiteV1 *properties = nullptr;
    const OfxParameterSuiteV1 *parameters = nullptr;
    const OfxImageEffectSuiteV1 *effects = nullptr;
    const OfxMessageSuiteV1 *messages = nullptr; // null if the host has none
    const OfxMessageSuiteV2 *lasting = nullptr;  // the same
    OfxPropertySetHandle host = nullptr;         // properties; null if the host gives none
};

// The suites. fetch_suites() returns false if the host lacks one that is needed.
const Suites &suites();
bool fetch_suites(OfxHost *host);

// A property; `otherwise` if the host does not have it.
std::string text_in(OfxPropertySetHandle set, const char *name, const std::string &otherwise = {});
int whole_in(OfxPropertySetHandle set, const char *name, int index, int otherwise);
double number_in(OfxPropertySetHandle set, const char *name, int index, double otherwise);
void *pointer_in(OfxPropertySetHandle set, const char *name);

// Sets a property. A host that does not know it ignores it.
void set(OfxPropertySetHandle set, const char *name, const std::string &value, int index = 0);
void set(OfxPropertySetHandle set, const char *name, int value, int index = 0);
void set(OfxPropertySetHandle set, const char *name, double value, int index = 0);

OfxPropertySetHandle properties_of(OfxImageEffectHandle effect);
OfxParamSetHandle parameters_of(OfxImageEffectHandle effect);

// Shows the error beside the effect until the next clear_error(). A host without windows also gets it on standard
// error.
void show_error(OfxImageEffectHandle effect, const std::string &why);
void clear_error(OfxImageEffectHandle effect);

// Thrown where the host does not do what it must.
struct HostError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

} // namespace sparselens_ofx
