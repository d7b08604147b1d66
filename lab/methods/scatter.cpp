#include "lab/methods/scatter.h"

#include "base/parallel.h"
#include "dof/selective/splats.h"
#include "lens/psf.h"

#include <algorithm>
#include <cmath>

namespace sparselens {

namespace {

struct Fragment {
    int bin;
    double weight;     // PSF weight in the destination pixel
    std::size_t splat; // index
};

std::vector<Splat> all_splats(const SplatSource &source) {
    std::vector<Splat> splats;
    for (std::size_t pixel = 0; pixel < source.ldi().windows.pixels(); ++pixel)
        source.for_each(pixel, [&](const Splat &splat) { splats.push_back(splat); });
    return splats;
}

// The pixels of a box that the splat's disc can touch.
Imath::Box2i footprint(const Splat &splat, double pixel_aspect, const Imath::Box2i &box) {
    const double rx = std::abs(splat.coc), ry = rx * pixel_aspect;
    const auto low = [](double v, int bound) {
        return v < bound ? bound : int(std::min(std::floor(v), bound + 1e6));
    };
    const auto high = [](double v, int bound) {
        return v > bound ? bound : int(std::max(std::floor(v), bound - 1e6));
    };
    return {{low(splat.position.x - rx, box.min.x), low(splat.position.y - ry, box.min.y)},
            {high(splat.position.x + rx, box.max.x), high(splat.position.y + ry, box.max.y)}};
}

// The fragments that fall into each pixel of the box, row by row.
std::vector<std::vector<Fragment>> fragments_in(const Imath::Box2i &box, const std::vector<Splat> &splats,
                                                double pixel_aspect) {
    const Grid grid(box);
    std::vector<std::vector<Fragment>> fragments(grid.size());
    for (std::size_t i = 0; i < splats.size(); ++i) {
        const Psf psf{splats[i].position, std::abs(splats[i].coc), pixel_aspect};
        const Imath::Box2i touched = footprint(splats[i], pixel_aspect, box);
        for (int y = touched.min.y; y <= touched.max.y; ++y)
            for (int x = touched.min.x; x <= touched.max.x; ++x) {
                const double weight = psf_weight(psf, x, y);
                if (weight == 0) continue;
                fragments[grid.index(Imath::V2i(x, y))].push_back({splats[i].bin, weight, i});
            }
    }
    return fragments;
}

// Sums of the fragments bin by bin, front to back, and the bins' numbers.
struct Bins {
    std::vector<int> numbers;
    std::vector<double> sums; // [bin][size]
};

Bins sum_bins(std::vector<Fragment> &fragments, const std::vector<Splat> &splats, const SplatSource &source,
              std::size_t size) {
    std::stable_sort(fragments.begin(), fragments.end(),
                     [](const auto &a, const auto &b) { return a.bin < b.bin; });
    Bins bins;
    for (const auto &[bin, weight, index] : fragments) {
        if (bins.numbers.empty() || bin != bins.numbers.back()) {
            bins.numbers.push_back(bin);
            bins.sums.resize(bins.sums.size() + size);
        }
        const Splat &splat = splats[index];
        double *sum = &bins.sums[bins.sums.size() - size];
        *sum++ += weight * splat.coverage;
        *sum++ += weight * splat.known;
        for (const std::size_t channel : source.colours()) *sum++ += weight * source.colour(splat, channel);
        *sum += weight * splat.known * std::abs(splat.coc);
    }
    return bins;
}

// Blends the fragments of pixel (x, y); returns alpha.
double blend_fragments(std::vector<Fragment> &fragments, const std::vector<Splat> &splats,
                       const SplatSource &source, int x, int y, std::span<double> colours) {
    const std::size_t layer_size = sums_before_colours + colours.size(), bin_size = layer_size + 1;
    const Bins bins = sum_bins(fragments, splats, source, bin_size);
    std::vector<double> layers;
    int last_bin = 0;
    for (std::size_t i = 0; i < bins.numbers.size(); ++i) {
        const double *sums = &bins.sums[i * bin_size], known = sums[1];
        if (known <= kernels::least_known) continue;
        const double scale = 1 / window_share(source.ldi().windows.data, source.lens().pixel_aspect, x, y,
                                              sums[bin_size - 1] / known);
        if (layers.empty() || bins.numbers[i] > last_bin + 1) layers.resize(layers.size() + layer_size);
        double *layer = &layers[layers.size() - layer_size];
        for (std::size_t k = 0; k < layer_size; ++k) layer[k] += scale * sums[k];
        last_bin = bins.numbers[i];
    }
    return blend_layers(layers, colours);
}

void scatter_into(Image &image, const Imath::Box2i &box, const std::vector<Splat> &splats,
                  const SplatSource &source) {
    auto fragments = fragments_in(box, splats, source.lens().pixel_aspect);
    std::vector<double> colours(source.colours().size());
    auto list = fragments.begin();
    for (int y = box.min.y; y <= box.max.y; ++y)
        for (int x = box.min.x; x <= box.max.x; ++x, ++list) {
            const double alpha = blend_fragments(*list, splats, source, x, y, colours);
            set_pixel(image, source, x, y, alpha, colours);
        }
}

// An estimate of the number of fragments per pixel.
double fragments_per_pixel(const std::vector<Splat> &splats, const Imath::Box2i &data, double pixel_aspect) {
    double sum = 0;
    for (const Splat &splat : splats) {
        const Imath::V2d size = Imath::V2d(footprint(splat, pixel_aspect, data).size()) + Imath::V2d(1, 1);
        sum += size.x * size.y;
    }
    return sum / (double(data.size().x + 1) * double(data.size().y + 1));
}

} // namespace

Image scatter(const Ldi &ldi, const ThinLens &lens, const ScatterOptions &options, Progress &progress) {
    const SplatSource source(ldi, lens);
    const std::vector<Splat> splats = all_splats(source);
    Image image = image_with_ids(ldi);
    const Imath::Box2i &data = ldi.windows.data;
    // Parts of rows, small enough that the parts in progress stay within the limit.
    constexpr double in_flight = 64;
    const double pixels = double(options.fragments) / in_flight /
                          std::max(1.0, fragments_per_pixel(splats, data, lens.pixel_aspect));
    const int width = ldi.windows.width();
    const int part_width = int(std::clamp(pixels, 1.0, double(width)));
    const int part_height = int(std::clamp(pixels / width, 1.0, 32.0));
    const Tiles parts(data, part_width, part_height);
    progress.start("scatter", parts.count());
    parallel_for(parts.count(), [&](std::size_t part) {
        scatter_into(image, parts.box(part), splats, source);
        progress.advance();
    });
    return image;
}

} // namespace sparselens
