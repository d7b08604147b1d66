#include "base/error.h"
#include "io/display/oiio_module.h"

#include <dlfcn.h>

#include <filesystem>
#include <string>
#include <system_error>

namespace sparselens {

namespace {

// When installed, and in the build folder, programs lie in bin/ and modules in lib/ beside it.
std::string beside_program(const std::string &module) {
    std::error_code unknown;
    const auto program = std::filesystem::read_symlink("/proc/self/exe", unknown);
    return (program.parent_path().parent_path() / SPARSELENS_MODULES / module).string();
}

// A program that loads this code from a library or a module may lie anywhere; modules then lie in lib/ of a folder
// above that library. Empty if there is none.
std::string above_this_code(const std::string &module) {
    Dl_info found;
    std::error_code unknown;
    if (::dladdr(reinterpret_cast<const void *>(&above_this_code), &found) == 0) return {};
    const auto library = std::filesystem::weakly_canonical(found.dli_fname, unknown);
    for (auto folder = library.parent_path(); folder != folder.parent_path(); folder = folder.parent_path())
        if (const auto path = folder / SPARSELENS_MODULES / module; std::filesystem::exists(path, unknown))
            return path.string();
    return {};
}

OiioModule load() {
    const std::string name = SPARSELENS_OIIO_MODULE;
    void *module = nullptr;
    for (const std::string &path :
         {beside_program(name), above_this_code(name), SPARSELENS_PREFIX "/" SPARSELENS_MODULES "/" + name})
        if (!module && !path.empty()) module = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    void *entry = module ? ::dlsym(module, oiio_module_entry) : nullptr;
    if (!entry)
        throw Error(std::string("cannot load OpenImageIO, which writes PNG, JPEG and TIFF: ") + ::dlerror());
    return reinterpret_cast<OiioModule (*)()>(entry)();
}

} // namespace

const OiioModule &oiio_module() {
    static const OiioModule module = load(); // stays loaded
    return module;
}

} // namespace sparselens
