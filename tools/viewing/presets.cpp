#include "viewing/presets.h"

#include <filesystem>
#include <system_error>

namespace sparselens {

Presets lens_presets() {
    Presets presets;
    std::error_code unknown;
    const auto folder = std::filesystem::read_symlink("/proc/self/exe", unknown).parent_path().parent_path();
    for (const auto &lenses : {folder / "share/sparselens/lenses", folder.parent_path() / "share/lenses"})
        for (const auto &file : std::filesystem::directory_iterator(lenses, unknown))
            if (file.path().extension() == ".json")
                presets.emplace(file.path().stem().string(), file.path().string());
    return presets;
}

} // namespace sparselens
