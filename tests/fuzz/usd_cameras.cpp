// Any bytes as cameras in JSON: read, placed, and made the views around them.
#include "chain/plan_views.h"
#include "fuzz/fuzz.h"
#include "io/usd/usd_camera.h"

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

using namespace sparselens;

namespace {

// Files of JSON are known by their names.
std::string file_with(std::string_view text) {
    const auto name = "usd_cameras." + std::to_string(::getpid()) + ".json";
    const std::string file = std::filesystem::temp_directory_path() / name;
    std::ofstream(file, std::ios::binary) << text;
    return file;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    const std::string file = file_with(fuzz::text_of(data, size));
    fuzz::may_fail([&] {
        const UsdCameras usd = read_usd_cameras(file, {});
        for (const UsdCamera &camera : usd.cameras)
            for (const double time : {-1.0, 1.5, 1e6})
                fuzz::may_fail([&] {
                    const Camera at = with_film(film_camera(usd, camera, time), {}, windows_of_size(16, 9));
                    if (!(*at.field > 0) || !std::isfinite((*at.world_to_camera)[3][0])) __builtin_trap();
                });
    });
    fuzz::may_fail([&] {
        const UsdViews views = views_of_shot(
            {.camera = {.file = file, .frame = 3}, .size = Imath::V2i(16, 9)}, [](const Notice &) {});
        if (views.lens_points.size() != 4 || usd_views_json(views).empty()) __builtin_trap();
    });
    ::unlink(file.c_str());
    return 0;
}
