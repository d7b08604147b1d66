#include "base/error.h"
#include "io/oiio_module.h"

#include <dlfcn.h>

#include <string>

namespace sparselens {

namespace {

OiioModule load() {
    const std::string name = SPARSELENS_OIIO_MODULE;
    void *module = nullptr;
    for (const std::string &path : {name, SPARSELENS_MODULE_FOLDER "/" + name})
        if (!module) module = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    void *entry = module ? ::dlsym(module, oiio_module_entry) : nullptr;
    if (!entry) throw Error(std::string("cannot load OpenImageIO: ") + ::dlerror());
    return reinterpret_cast<OiioModule (*)()>(entry)();
}

} // namespace

const OiioModule &oiio_module() {
    static const OiioModule module = load(); // stays loaded
    return module;
}

} // namespace sparselens
