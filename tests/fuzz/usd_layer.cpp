// Any bytes as a layer of USD: read, its cameras found and placed, and written as views, which are read again.
#include "io/usd/usd_layer.h"

#include "chain/usd_shot.h"
#include "fuzz/fuzz.h"
#include "io/files/text_file.h"
#include "io/usd/usd_camera.h"

#include <cmath>

using namespace sparselens;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    const MemoryFile file(fuzz::text_of(data, size));
    fuzz::may_fail([&] {
        const UsdCameras usd(file.path());
        for (const UsdPath &camera : usd.cameras)
            for (const double time : {-1.0, 1.5, 1e6})
                fuzz::may_fail([&] {
                    const Camera at = with_film(film_camera(usd, camera, time), {}, windows_of_size(16, 9));
                    if (!(*at.field > 0) || !std::isfinite((*at.world_to_camera)[3][0])) __builtin_trap();
                });
    });
    fuzz::may_fail([&] {
        const UsdViews views = views_of_shot(
            {.camera = {.file = file.path(), .frame = 3}, .size = Imath::V2i(16, 9)}, [](const Notice &) {});
        const MemoryFile written(usd_text(views));
        const UsdCameras again(written.path()); // what is written is read
        if (again.cameras.size() != 5) __builtin_trap();
    });
    return 0;
}
