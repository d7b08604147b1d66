// Times EXR reading and writing: an LDI as a deep file, a picture as a flat one, with the threads given to OpenEXR.
#include "io/exr/exr_deep.h"
#include "io/exr/exr_flat.h"
#include "support/ldi_samples.h"
#include "support/scratch_folder.h"

#include <benchmark/benchmark.h>

#include <cmath>

namespace sparselens {
namespace {

Ldi ldi() { return random_ldi({.width = 640, .height = 360, .most_samples = 3}); }

void writing_deep(benchmark::State &state) {
    const ScratchFolder folder;
    const Ldi picture = ldi();
    for (auto _ : state) write_ldi(folder.file("deep.exr"), picture, Imf::Header());
    state.SetItemsProcessed(state.iterations() * std::int64_t(picture.samples()));
}

void reading_deep(benchmark::State &state) {
    const ScratchFolder folder;
    write_ldi(folder.file("deep.exr"), ldi(), Imf::Header());
    std::size_t samples = 0;
    for (auto _ : state) samples += read_ldi(folder.file("deep.exr")).ldi.samples();
    state.SetItemsProcessed(std::int64_t(samples));
}

Image picture() {
    Image image(windows_of_size(640, 360), rgba_channels());
    for (std::size_t i = 0; i < image.values.size(); ++i) image.values[i] = std::sin(float(i) * 0.1f);
    return image;
}

void writing_flat(benchmark::State &state) {
    const ScratchFolder folder;
    const Image image = picture();
    for (auto _ : state) write_flat_exr(folder.file("flat.exr"), image, Imf::Header());
    state.SetItemsProcessed(state.iterations() * std::int64_t(image.windows.pixels()));
}

void reading_flat(benchmark::State &state) {
    const ScratchFolder folder;
    write_flat_exr(folder.file("flat.exr"), picture(), Imf::Header());
    std::size_t pixels = 0;
    for (auto _ : state) pixels += read_flat_exr(folder.file("flat.exr")).image.windows.pixels();
    state.SetItemsProcessed(std::int64_t(pixels));
}

BENCHMARK(writing_deep)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(reading_deep)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(writing_flat)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(reading_flat)->UseRealTime()->Unit(benchmark::kMillisecond);

} // namespace
} // namespace sparselens
