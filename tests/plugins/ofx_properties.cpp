// The suite of properties.
#include "ofx_model.h"

namespace ofx_host {

namespace {

Properties &properties_of(OfxPropertySetHandle handle) { return *reinterpret_cast<Properties *>(handle); }

template <typename T, typename Given>
OfxStatus set_one(OfxPropertySetHandle set, const char *name, int index, Given value) {
    if (!set) return kOfxStatErrBadHandle;
    properties_of(set).set<T>(name, T(value), index);
    return kOfxStatOK;
}
template <typename T, typename Given>
OfxStatus set_all(OfxPropertySetHandle set, const char *name, int count, const Given *values) {
    for (int i = 0; i < count; ++i) set_one<T>(set, name, i, values[i]);
    return kOfxStatOK;
}
OfxStatus set_strings(OfxPropertySetHandle set, const char *name, int count, const char *const *values) {
    return set_all<std::string>(set, name, count, values);
}
OfxStatus set_pointers(OfxPropertySetHandle set, const char *name, int count, void *const *values) {
    return set_all<void *>(set, name, count, values);
}

template <typename T>
T *found(OfxPropertySetHandle set, const char *name, int index) {
    auto &values = properties_of(set).values;
    const auto there = values.find(name);
    if (there == values.end() || index < 0 || std::size_t(index) >= there->second.size()) return nullptr;
    return std::get_if<T>(&there->second[std::size_t(index)]);
}
template <typename T>
OfxStatus get_one(OfxPropertySetHandle set, const char *name, int index, T *value) {
    if (!set) return kOfxStatErrBadHandle;
    const T *there = found<T>(set, name, index);
    if (!there) return kOfxStatErrUnknown;
    *value = *there;
    return kOfxStatOK;
}
OfxStatus get_string(OfxPropertySetHandle set, const char *name, int index, char **value) {
    if (!set) return kOfxStatErrBadHandle;
    std::string *there = found<std::string>(set, name, index);
    if (!there) return kOfxStatErrUnknown;
    *value = there->data();
    return kOfxStatOK;
}
template <typename T>
OfxStatus get_all(OfxPropertySetHandle set, const char *name, int count, T *values) {
    for (int i = 0; i < count; ++i)
        if (const OfxStatus status = get_one(set, name, i, values + i); status != kOfxStatOK) return status;
    return kOfxStatOK;
}
OfxStatus get_strings(OfxPropertySetHandle set, const char *name, int count, char **values) {
    for (int i = 0; i < count; ++i) get_string(set, name, i, values + i);
    return kOfxStatOK;
}
OfxStatus reset(OfxPropertySetHandle set, const char *name) {
    properties_of(set).values.erase(name);
    return kOfxStatOK;
}
OfxStatus dimension(OfxPropertySetHandle set, const char *name, int *count) {
    const Properties &all = properties_of(set);
    *count = all.has(name) ? int(all.values.at(name).size()) : 0;
    return kOfxStatOK;
}

const OfxPropertySuiteV1 suite{set_one<void *, void *>,
                               set_one<std::string, const char *>,
                               set_one<double, double>,
                               set_one<int, int>,
                               set_pointers,
                               set_strings,
                               set_all<double, double>,
                               set_all<int, int>,
                               get_one<void *>,
                               get_string,
                               get_one<double>,
                               get_one<int>,
                               get_all<void *>,
                               get_strings,
                               get_all<double>,
                               get_all<int>,
                               reset,
                               dimension};

} // namespace

const void *property_suite() { return &suite; }

} // namespace ofx_host
