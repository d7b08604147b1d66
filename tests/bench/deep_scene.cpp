// sparselens-deep-scene NAME WIDTH HEIGHT OUT.exr: writes a scene of support/deep_scenes.h, compressed by ZIPS.
#include "base/error.h"
#include "io/camera/camera_header.h"
#include "io/exr/exr_deep.h"
#include "support/deep_scenes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <string>

using namespace sparselens;

namespace {

const DeepScene &scene_of(const std::string &name) {
    const auto found =
        std::ranges::find_if(deep_scenes(), [&](const DeepScene &s) { return s.name == name; });
    if (found == deep_scenes().end())
        throw UsageError(fmt::format("no scene {}: must be one of apart, dense, hair, tinted, volume", name));
    return *found;
}

} // namespace

int main(int argc, char **argv) {
    if (argc != 5) {
        fmt::print(stderr, "sparselens-deep-scene NAME WIDTH HEIGHT OUT.exr: NAME is apart, dense, hair, "
                           "tinted or volume\n");
        return 2;
    }
    try {
        const int width = std::stoi(argv[2]), height = std::stoi(argv[3]);
        const Ldi ldi = scene_of(argv[1]).make(width, height);
        Imf::Header header;
        write_camera(header, deep_scene_camera(width));
        write_ldi(argv[4], ldi, header, Imf::ZIPS_COMPRESSION);
        return 0;
    } catch (const std::exception &error) {
        fmt::print(stderr, "sparselens-deep-scene: {}\n", error.what());
        return 1;
    }
}
