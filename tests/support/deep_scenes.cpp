#include "support/deep_scenes.h"

#include "base/numbers.h"
#include "base/parallel.h"

#include <array>
#include <cmath>
#include <functional>

namespace sparselens {

namespace {

constexpr double focus = 10, farthest_coc = 20; // scene units; pixels, at infinity

double depth_of_coc(double coc) { return focus / (1 - coc / farthest_coc); }

// Sample `layer` of a pixel, front to back.
struct LayerSample {
    double coc, coc_back; // pixels; the same for a point
    double alpha;
};

struct Layers {
    std::function<int(int x, int y)> count;
    std::function<LayerSample(int x, int y, int layer)> sample;
    bool volumes = false;
};

Ldi make_layers(int width, int height, const Layers &layers) {
    Ldi ldi;
    ldi.windows = windows_of_size(width, height);
    ldi.channels = rgba_channels();
    ldi.begin.resize(ldi.windows.pixels() + 1);
    for (std::size_t i = 0; i < ldi.windows.pixels(); ++i)
        ldi.begin[i + 1] =
            ldi.begin[i] + std::uint64_t(layers.count(ldi.windows.pixel(i).x, ldi.windows.pixel(i).y));
    ldi.z.resize(ldi.begin.back());
    if (layers.volumes) ldi.z_back.resize(ldi.z.size());
    ldi.values.assign(4, std::vector<float>(ldi.z.size()));
    parallel_ranges(ldi.windows.pixels(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t pixel = begin; pixel < end; ++pixel) {
            const Imath::V2i at = ldi.windows.pixel(pixel);
            for (const std::uint64_t i : ldi.pixel(pixel)) {
                const int layer = int(i - ldi.begin[pixel]);
                const LayerSample s = layers.sample(at.x, at.y, layer);
                ldi.z[i] = float(depth_of_coc(s.coc));
                if (layers.volumes) ldi.z_back[i] = float(depth_of_coc(s.coc_back));
                const std::uint32_t place = mix_bits(std::uint32_t(at.x), std::uint32_t(at.y));
                for (std::uint32_t k = 0; k < 3; ++k)
                    ldi.values[k][i] =
                        float(s.alpha * unit_interval(mix_bits(place, std::uint32_t(layer) * 3 + k)));
                ldi.values[3][i] = float(s.alpha);
            }
        }
    });
    return ldi;
}

double wave(int x, int y, int i) { return std::sin(0.05 * x * (1 + 0.1 * i)) * std::cos(0.07 * y + i); }

Ldi dense(int width, int height) {
    const auto sample = [](int x, int y, int i) {
        const double group = i / 4,
                     coc = (group == 0 ? 0.25 : 0.25 + 3.75 * group / 4) + 0.06 * double(i % 4);
        return LayerSample{coc, coc, i == 19 ? 1 : 0.5 * (0.5 + 0.5 * wave(x, y, i))};
    };
    return make_layers(width, height, {[](int, int) { return 20; }, sample});
}

Ldi apart(int width, int height) {
    const auto sample = [](int x, int y, int i) {
        const double coc = -4 + 0.5 * i;
        return LayerSample{coc, coc, i == 19 ? 1 : 0.5 * (0.5 + 0.5 * wave(x, y, i))};
    };
    return make_layers(width, height, {[](int, int) { return 20; }, sample});
}

Ldi tinted(int width, int height) {
    Ldi ldi = dense(width, height);
    const std::vector<float> alpha = ldi.values.back();
    for (const auto &[name, share] : {std::pair("AR", 0.9f), {"AG", 0.75f}, {"AB", 0.6f}}) {
        ldi.channels.push_back({name});
        ldi.values.push_back(alpha);
        for (float &value : ldi.values.back())
            if (value < 1) value *= share;
    }
    return ldi;
}

Ldi hair(int width, int height) {
    const auto in_tuft = [](int x, int y) {
        return unit_interval(mix_bits(std::uint32_t(x / 32), std::uint32_t(y / 64) + 977)) < 0.1;
    };
    const auto sample = [in_tuft](int x, int y, int i) {
        if (!in_tuft(x, y) || i == 60) return LayerSample{6, 6, 1};
        const std::uint32_t strand =
            mix_bits(std::uint32_t(x), mix_bits(std::uint32_t(y / 8), std::uint32_t(i)));
        const double coc = -3 + 4 * (i + 0.9 * unit_interval(strand)) / 60;
        return LayerSample{coc, coc, 0.02 + 0.3 * unit_interval(mix_bits(strand))};
    };
    return make_layers(width, height, {[in_tuft](int x, int y) { return in_tuft(x, y) ? 61 : 1; }, sample});
}

Ldi volume(int width, int height) {
    const auto sample = [](int x, int y, int i) {
        const double swell = std::sin(0.02 * x + 0.1 * i) * std::cos(0.03 * y - 0.05 * i);
        return LayerSample{-4 + 0.1 * i, -4 + 0.1 * (i + 1), 0.02 + 0.018 * swell};
    };
    return make_layers(width, height, {[](int, int) { return 100; }, sample, true});
}

constexpr std::array scenes{DeepScene{"apart", apart}, DeepScene{"dense", dense}, DeepScene{"hair", hair},
                            DeepScene{"tinted", tinted}, DeepScene{"volume", volume}};

} // namespace

std::span<const DeepScene> deep_scenes() { return scenes; }

Camera deep_scene_camera(int width) {
    Camera camera;
    camera.focal_length_mm = 50;
    camera.sensor_width_mm = 36;
    camera.focus_distance = focus;
    camera.lens_radius = farthest_coc * focus / (50.0 / 36 * width);
    return camera;
}

} // namespace sparselens
