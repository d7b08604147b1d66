// Reads .dof files as programs do that use OpenImageIO, for scripts.
//
//   reader version MODULE            the module is of this version of OpenImageIO
//   reader threads NAME.dof EXR      eight threads read tiles of all sizes: by an ImageCache, by one ImageInput, and by
//                                    readers of their own; each equals the EXR file
//   reader again NAME.dof COMMAND    reads twice, with the shell's COMMAND between: prints whether the pixels changed
//   reader memory NAME.dof           prints how far the memory grows, in pictures, while it is read by rows and whole
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imagecache.h>
#include <OpenImageIO/imageio.h>
#include <dlfcn.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace {

using namespace OIIO;

constexpr int threads = 8;

void require(bool holds, const std::string &what) {
    if (!holds) throw std::runtime_error(what + " " + geterror());
}

std::unique_ptr<ImageInput> opened(const std::string &name) {
    auto input = ImageInput::open(name);
    require(input != nullptr, name);
    return input;
}

std::vector<float> pixels_of(ImageInput &input, int level) {
    const ImageSpec spec = input.spec(0, level);
    std::vector<float> pixels(std::size_t(spec.image_pixels()) * std::size_t(spec.nchannels));
    require(input.read_image(0, level, 0, spec.nchannels, TypeFloat, pixels.data()),
            "read: " + input.geterror());
    return pixels;
}

// Calls work(number) on all threads at the same time.
void on_threads(const std::function<void(int)> &work) {
    std::atomic<int> failed = 0;
    std::vector<std::thread> all;
    for (int i = 0; i < threads; ++i)
        all.emplace_back([&, i] {
            try {
                work(i);
            } catch (const std::exception &error) {
                ++failed;
                std::fprintf(stderr, "reader: %s\n", error.what());
            }
        });
    for (std::thread &thread : all) thread.join();
    require(failed == 0, "a thread failed");
}

// Whether the tile at x,y of a picture is that part of all its pixels.
bool is_part(const std::vector<float> &tile, const std::vector<float> &all, const ImageSpec &spec, int x,
             int y) {
    const auto channels = std::size_t(spec.nchannels);
    const int right = std::min(x + spec.tile_width, spec.x + spec.width);
    const int bottom = std::min(y + spec.tile_height, spec.y + spec.height);
    for (int line = y; line < bottom; ++line) {
        const float *given = &tile[std::size_t(line - y) * std::size_t(spec.tile_width) * channels];
        const float *expected =
            &all[(std::size_t(line - spec.y) * std::size_t(spec.width) + std::size_t(x - spec.x)) * channels];
        if (!std::equal(given, given + std::size_t(right - x) * channels, expected)) return false;
    }
    return true;
}

void read_tiles(ImageInput &input, int level, const std::vector<float> &all, int from) {
    const ImageSpec spec = input.spec(0, level);
    const int across = (spec.width + spec.tile_width - 1) / spec.tile_width;
    const int down = (spec.height + spec.tile_height - 1) / spec.tile_height;
    const TypeDesc type = spec.format; // of all channels
    std::vector<char> native(spec.tile_bytes(true));
    std::vector<float> tile(std::size_t(spec.tile_pixels()) * std::size_t(spec.nchannels));
    for (int i = 0; i < across * down; ++i) { // each thread begins elsewhere
        const int number = (i + from) % (across * down);
        const int x = spec.x + number % across * spec.tile_width,
                  y = spec.y + number / across * spec.tile_height;
        require(input.read_native_tile(0, level, x, y, 0, native.data()), "tile: " + input.geterror());
        require(convert_pixel_values(type, native.data(), TypeFloat, tile.data(), int(tile.size())),
                "convert");
        require(is_part(tile, all, spec, x, y), "a tile has other pixels");
    }
}

void test_threads(const std::string &name, const std::string &exr) {
    const auto file = opened(exr);
    const std::vector<float> expected = pixels_of(*file, 0);
    const auto shared = opened(name);
    std::vector<std::vector<float>> levels;
    for (int level = 0; shared->seek_subimage(0, level); ++level) levels.push_back(pixels_of(*shared, level));
    require(levels.size() == 4, "not four sizes but " + std::to_string(levels.size()));
    require(levels[0] == expected, "other pixels than those of dof-gather");
    on_threads([&](int i) {
        for (int level = 0; level < 4; ++level)
            read_tiles(*shared, (level + i) % 4, levels[std::size_t((level + i) % 4)], i);
    });
    on_threads([&](int i) { read_tiles(*opened(name), i % 4, levels[std::size_t(i % 4)], i); });
    const auto cache = ImageCache::create(false);
    const ImageSpec spec = shared->spec(0, 0);
    on_threads([&](int) {
        std::vector<float> all(expected.size());
        require(cache->get_pixels(ustring(name), 0, 0, spec.x, spec.x + spec.width, spec.y,
                                  spec.y + spec.height, 0, 1, TypeFloat, all.data()),
                "ImageCache: " + cache->geterror());
        require(all == expected, "ImageCache has other pixels");
    });
#if OIIO_VERSION_MAJOR < 3
    ImageCache::destroy(cache);
#endif
}

void test_again(const std::string &name, const std::string &command) {
    const std::vector<float> before = pixels_of(*opened(name), 0);
    require(pixels_of(*opened(name), 0) == before, "the second reading differs");
    require(std::system(command.c_str()) == 0, command);
    std::puts(pixels_of(*opened(name), 0) == before ? "same" : "changed");
}

double peak_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return 1024.0 * double(usage.ru_maxrss);
}

void test_memory(const std::string &name) {
    const auto input = opened(name);
    const ImageSpec spec = input->spec(0, 0);
    std::vector<char> all(spec.image_bytes(true), '\1'); // the program's own memory
    const double before = peak_bytes();
    for (int y = spec.y; y < spec.y + spec.height; ++y)
        require(input->read_native_scanline(0, 0, y, 0, all.data()), "row: " + input->geterror());
    require(input->read_native_scanlines(0, 0, spec.y, spec.y + spec.height, 0, all.data()),
            "picture: " + input->geterror());
    std::printf("%.3f\n", (peak_bytes() - before) / double(spec.image_bytes(true)));
}

void test_version(const std::string &module) {
    void *const library = ::dlopen(module.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library) throw std::runtime_error(::dlerror());
    const auto *version = static_cast<const int *>(::dlsym(library, "dof_imageio_version"));
    require(version && *version == OIIO_PLUGIN_VERSION, "another version");
}

} // namespace

int main(int count, char **words) {
    try {
        const std::string what = count > 2 ? words[1] : "";
        if (what == "version")
            test_version(words[2]);
        else if (what == "threads" && count > 3)
            test_threads(words[2], words[3]);
        else if (what == "again" && count > 3)
            test_again(words[2], words[3]);
        else if (what == "memory")
            test_memory(words[2]);
        else
            return 2;
        return 0;
    } catch (const std::exception &error) {
        std::fprintf(stderr, "reader: %s\n", error.what());
        return 1;
    }
}
