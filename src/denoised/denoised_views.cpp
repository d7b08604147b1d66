#include "denoised/denoised_views.h"

#include "base/channel_kind.h"
#include "base/error.h"
#include "base/parallel.h"
#include "kernels/surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace sparselens {

namespace {

using Layer = std::vector<std::size_t>; // channels of the views

struct NewPlane {
    std::size_t channel;
    Values values;
};

void check_is_flat(const PackedView &view) {
    if (view.samples.deep())
        throw Error(view.name +
                    ": is deep, and denoisers make flat pictures: leave out `denoised` and `noisy`");
}

void check_windows(const PackedView &view, const DenoisedPicture &denoised) {
    if (view.samples.windows == denoised.image.windows) return;
    throw Error(
        fmt::format("{}: its windows are not those of {}: denoise the view without cropping or scaling it",
                    denoised.name, view.name));
}

bool has_all(const DenoisedPicture &denoised, std::span<const Channel> channels, const Layer &layer) {
    return std::ranges::all_of(layer, [&](std::size_t c) {
        return find_channel(denoised.image.channels, channels[c].name) != npos;
    });
}

// The layers that all denoised pictures have, except coverage.
std::vector<Layer> denoised_layers(std::span<const PackedView> views,
                                   std::span<const DenoisedPicture> denoised) {
    const std::vector<Channel> &channels = views[0].samples.channels;
    std::vector<Layer> layers;
    for (const Layer &layer : colour_layers(channels)) {
        if (layer.size() > 3 || colour_part(channels[layer[0]]) == ColourPart::coverage) continue;
        if (std::ranges::all_of(denoised,
                                [&](const auto &picture) { return has_all(picture, channels, layer); }))
            layers.push_back(layer);
    }
    if (layers.empty())
        throw Error(fmt::format("{}: the denoised pictures have no colours that {} has", denoised[0].name,
                                views[0].name));
    return layers;
}

DenoisedLayer layer_of(const PackedView &view, const DenoisedPicture &denoised,
                       std::span<const Channel> channels, const Layer &layer, const ViewMapping &mapping) {
    const Grid grid = view.samples.windows.grid();
    DenoisedLayer made{grid, view.samples.depths(), mapping, {}, {}};
    for (const std::size_t c : layer) {
        Values noisy(grid.size());
        view.samples.front_values(channel_of(view.name, view.samples.channels, channels[c]), 0, noisy);
        made.noisy.push_back(std::move(noisy));
        const auto plane = denoised.image.plane(find_channel(denoised.image.channels, channels[c].name));
        made.denoised.emplace_back(plane.begin(), plane.end());
    }
    return made;
}

// Throws Error if a denoised picture is clearly nearer to another view than to its own.
void check_order(std::span<const DenoisedLayer> layers, std::span<const PackedView> views,
                 std::span<const DenoisedPicture> denoised) {
    const std::size_t count = views.size();
    std::vector<double> apart(count * count); // of each picture from each view; 0 if their sizes differ
    parallel_for(apart.size(), [&](std::size_t i) {
        const Values &a = layers[i / count].denoised[0], &b = layers[i % count].noisy[0];
        double sum = 0;
        for (std::size_t k = 0; a.size() == b.size() && k < a.size(); ++k)
            sum += double(std::abs(a[k] - b[k]) / (std::abs(a[k]) + std::abs(b[k]) + 1e-20f));
        apart[i] = sum;
    });
    for (std::size_t p = 0; p < count; ++p)
        for (std::size_t v = 0; v < count; ++v)
            if (layers[p].grid.size() == layers[v].grid.size() &&
                apart[p * count + v] < 0.9 * apart[p * count + p])
                throw Error(
                    fmt::format("{}: shows what {} shows, not {}: give `denoised` in the order of the views",
                                denoised[p].name, views[v].name, views[p].name));
}

// Adds the kept share of the details that the denoised values lack.
void blend(DenoisedLayer &layer, const Values &kept) {
    parallel_ranges(kept.size(), std::size_t(1) << 14, [&](std::size_t begin, std::size_t end) {
        for (std::size_t c = 0; c < layer.noisy.size(); ++c)
            for (std::size_t i = begin; i < end; ++i) {
                const float denoised = layer.denoised[c][i];
                layer.noisy[c][i] = denoised + kept[i] * (layer.noisy[c][i] - denoised);
            }
    });
}

// The changed planes of each view.
std::vector<std::vector<NewPlane>> new_planes(std::span<const PackedView> views,
                                              std::span<const DenoisedPicture> denoised, double focal_px,
                                              double scale) {
    const std::vector<Channel> &channels = views[0].samples.channels;
    std::vector<std::vector<NewPlane>> planes(views.size());
    for (const Layer &layer : denoised_layers(views, denoised)) {
        std::vector<DenoisedLayer> layers;
        std::vector<AveragedLayer> means;
        for (std::size_t v = 0; v < views.size(); ++v) {
            const ViewMapping mapping(views[v].position, focal_px, views[v].samples.windows, views[v].framing,
                                      views[0].framing.principal_point);
            layers.push_back(layer_of(views[v], denoised[v], channels, layer, mapping));
            means.push_back(averaged(layers[v], scale));
        }
        check_order(layers, views, denoised);
        std::vector<Values> kept;
        for (std::size_t v = 0; v < views.size(); ++v) kept.push_back(kept_details(layers, means, v, scale));
        for (std::size_t v = 0; v < views.size(); ++v) {
            blend(layers[v], kept[v]);
            for (std::size_t k = 0; k < layer.size(); ++k)
                planes[v].push_back({channel_of(views[v].name, views[v].samples.channels, channels[layer[k]]),
                                     std::move(layers[v].noisy[k])});
        }
    }
    return planes;
}

std::size_t found(const PackedView &view, std::span<const Channel> channels, const std::string &name) {
    const std::size_t channel = find_channel(channels, name);
    if (channel == npos)
        throw Error(fmt::format("{}: has no channel {}: render it with its denoised and its noisy colours",
                                view.name, name));
    return channel;
}

} // namespace

DenoisedPicture part_denoised(PackedView &view, const std::string &noisy_layer) {
    check_is_flat(view);
    View both = unpacked(view);
    const std::vector<Channel> channels = both.image.channels;
    DenoisedPicture denoised{view.name, Image(both.image.windows, {})};
    std::vector<Channel> kept = channels;
    for (const char *name : rgb_names) {
        const std::size_t colour = found(view, channels, name),
                          noisy = found(view, channels, noisy_layer + "." + name);
        denoised.image.channels.push_back(channels[colour]);
        const auto from = both.image.plane(colour);
        denoised.image.values.insert(denoised.image.values.end(), from.begin(), from.end());
        std::ranges::copy(both.image.plane(noisy), from.begin());
    }
    const std::string guides = noisy_layer.substr(0, noisy_layer.rfind('.') + 1) + "Denoising "; // of Cycles
    std::erase_if(kept, [&](const Channel &channel) {
        return channel.name.starts_with(noisy_layer + ".") || channel.name.starts_with(guides);
    });
    PackedView parted(std::move(both));
    parted.samples.keep_channels(kept);
    view = std::move(parted);
    return denoised;
}

void take_denoised(std::vector<PackedView> &views, std::span<const DenoisedPicture> denoised, double focal_px,
                   double scale) {
    for (const PackedView &view : views) check_is_flat(view);
    for (std::size_t v = 0; v < views.size(); ++v) check_windows(views[v], denoised[v]);
    std::vector<std::vector<NewPlane>> planes = new_planes(views, denoised, focal_px, scale);
    for (std::size_t v = 0; v < views.size(); ++v) {
        View changed = unpacked(views[v]);
        for (const NewPlane &plane : planes[v])
            std::ranges::copy(plane.values, changed.image.plane(plane.channel).begin());
        planes[v] = {};
        views[v] = PackedView(std::move(changed));
    }
}

// Thresholds of denoised views, with units.
struct DenoisedTuning {
    // Differences are compared as means over squares of side 2 radius + 1, because details smaller than a pixel lie in
    // different pixels of different views. Pixels.
    static constexpr int detail_radius = 1;
    // Radius of the soft window over which details and noise are averaged, pixels. On fence, grass and mirror with 5
    // rays, a window half as large loses, and one twice as large gains .05 to .1 dB but the worst blocks lose .25.
    static constexpr int window_radius = 2;
    // By how many standard errors a single pixel must stand out to be kept, if other views show it too, and if none
    // does.
    static constexpr float standard_errors = 3, standard_errors_alone = 6;
    // For Gaussian noise, the mean of squared differences between a view and four others, over their geometric mean:
    // e^-(digamma(2) + ln 2 - ln 4) = 1.31. For the square of one value, over its own geometric mean: 3.56.
    static constexpr float mean_over_geometric = 1.31f, mean_over_geometric_alone = 3.56f;
    // The effect of rounding to half on a value, relative and squared.
    static constexpr float rounding = 0x1p-20f;
};

namespace {

using Tuning = DenoisedTuning;

// The details of one pixel, compared with those of other views at the same place. Means and squares run over the
// channels.
struct Evidence {
    float shared = 0;     // mean product with other views
    float difference = 0; // half of the mean squared difference
    float of_noisy = 0;   // the same of the noisy views
    float own = 0;        // its own square
    float stands_out = 0; // square of the mean over all views
    float views = 0;      // other views that show the pixel
};

// Four pixels of a view and their weights, around a place between them.
struct Between {
    std::size_t corner, right, below; // index of the upper left pixel; steps to its neighbours
    float x, y;                       // weights of the right and of the lower pixels

    float of(std::span<const float> values) const {
        const float *at = values.data() + corner;
        const float upper = at[0] + x * (at[right] - at[0]);
        const float lower = at[below] + x * (at[below + right] - at[below]);
        return upper + y * (lower - upper);
    }
};

// Returns false outside of the view.
bool between(const Grid &grid, const Imath::V2d &place, Between &found) {
    const Imath::Box2i box = grid.box();
    const double x = place.x - 0.5 - box.min.x, y = place.y - 0.5 - box.min.y;
    if (!(x >= 0 && y >= 0 && x <= grid.width() - 1 && y <= grid.height() - 1)) return false; // NaN, too
    const auto column = std::size_t(x), row = std::size_t(y);
    const auto width = std::size_t(grid.width());
    found = {row * width + column, column + 1 < width ? 1u : 0u,
             row + 1 < std::size_t(grid.height()) ? width : 0, float(x - double(column)),
             float(y - double(row))};
    return true;
}

// Whether the view shows, between those pixels, the surface at that inverse depth.
bool shows(const DenoisedLayer &view, const Between &at, double inverse_z, double scale) {
    double inverse[4];
    const std::size_t corners[] = {at.corner, at.corner + at.right, at.corner + at.below,
                                   at.corner + at.below + at.right};
    for (int k = 0; k < 4; ++k) {
        if (!(view.z[corners[k]] > 0)) return false;
        inverse[k] = 1 / double(view.z[corners[k]]);
    }
    const double upper = inverse[0] + double(at.x) * (inverse[1] - inverse[0]);
    const double lower = inverse[2] + double(at.x) * (inverse[3] - inverse[2]);
    return scale * std::abs(upper + double(at.y) * (lower - upper) - inverse_z) < double(one_surface_px);
}

// The pixels of a square around `own` that show the surface that `own` shows, itself included.
void same_surface_beside(const DenoisedLayer &view, std::size_t own, double scale,
                         std::vector<std::size_t> &found) {
    const Grid &grid = view.grid;
    const Imath::V2i at = grid.pixel(own);
    const double inverse_z = 1 / double(view.z[own]);
    const Imath::Box2i box = grid.box();
    constexpr int radius = Tuning::detail_radius;
    found.clear();
    for (int v = std::max(at.y - radius, box.min.y); v <= std::min(at.y + radius, box.max.y); ++v)
        for (int u = std::max(at.x - radius, box.min.x); u <= std::min(at.x + radius, box.max.x); ++u) {
            const std::size_t i = grid.index(Imath::V2i(u, v));
            const double apart = scale * std::abs(1 / double(view.z[i]) - inverse_z);
            if (i == own || (view.z[i] > 0 && apart < double(one_surface_px))) found.push_back(i);
        }
}

class Comparison {
public:
    Comparison(std::span<const DenoisedLayer> views, std::span<const AveragedLayer> means, std::size_t at,
               double scale)
        : views_(views), means_(means), at_(at), scale_(scale) {}

    Evidence of_pixel(std::size_t i) const {
        const DenoisedLayer &view = views_[at_];
        const Imath::V2i pixel = view.grid.pixel(i);
        const Imath::V2d centre(pixel.x + 0.5, pixel.y + 0.5);
        const double inverse_z = 1 / double(view.z[i]);
        const Imath::V2d place = view.mapping.at_infinity(centre) + view.mapping.parallax(centre) * inverse_z;
        Evidence found;
        std::array<float, 3> sum{};
        const std::size_t channels = means_[at_].noisy.size();
        for (std::size_t c = 0; c < channels; ++c) sum[c] = own(c, i);
        for (std::size_t k = 0; k < views_.size(); ++k) {
            Between at{};
            if (k == at_ || !between(views_[k].grid, views_[k].mapping.in_view(place, inverse_z), at))
                continue;
            if (!shows(views_[k], at, inverse_z, scale_)) continue;
            ++found.views;
            for (std::size_t c = 0; c < channels; ++c) {
                const float noisy = at.of(means_[k].noisy[c]);
                const float mine = own(c, i), other = noisy - at.of(means_[k].denoised[c]);
                sum[c] += other;
                const float beyond = noisy - means_[at_].denoised[c][i]; // what this view should have
                found.shared += mine * beyond;
                found.difference += (mine - other) * (mine - other) / 2;
                found.of_noisy += (mine - beyond) * (mine - beyond) / 2;
            }
        }
        for (std::size_t c = 0; c < channels; ++c) {
            found.own += own(c, i) * own(c, i);
            found.stands_out += sum[c] * sum[c] / ((found.views + 1) * (found.views + 1));
        }
        if (found.views > 0) {
            found.shared /= found.views;
            found.difference /= found.views;
            found.of_noisy /= found.views;
        }
        return found;
    }

private:
    float own(std::size_t channel, std::size_t i) const {
        return means_[at_].noisy[channel][i] - means_[at_].denoised[channel][i];
    }

    std::span<const DenoisedLayer> views_;
    std::span<const AveragedLayer> means_;
    std::size_t at_;
    double scale_;
};

// The planes that are averaged over windows. Where no other view shows a pixel, its part of the means over views is 0.
struct Planes {
    explicit Planes(std::size_t pixels)
        : shared(pixels), difference(pixels), of_noisy(pixels), log_difference(pixels), log_own(pixels),
          compared(pixels), stands_out(pixels), own_difference(pixels), views(pixels) {}

    void set(std::size_t i, const Evidence &found, float weight) {
        const float least = Tuning::rounding * weight * found.own + 1e-20f;
        shared[i] = weight * found.shared;
        difference[i] = weight * found.difference;
        of_noisy[i] = weight * found.of_noisy;
        compared[i] = found.views > 0;
        log_difference[i] = found.views > 0 ? std::log(weight * found.difference + least) : 0;
        log_own[i] = std::log(weight * found.own + least);
        stands_out[i] = weight * found.stands_out;
        own_difference[i] = weight * found.difference;
        views[i] = found.views;
    }

    // Averages over windows all planes except those that judge a single pixel.
    void average(const Grid &grid) {
        for (Values *values : {&shared, &difference, &of_noisy, &log_difference, &log_own, &compared})
            soft_mean(*values, grid.array(), Tuning::window_radius);
    }

    float kept(std::size_t i) const { return std::max(kept_in_window(i), kept_pixel(i)); }

private:
    float kept_in_window(std::size_t i) const {
        const float detail = std::max(shared[i], 0.0f), all = detail + std::min(difference[i], of_noisy[i]);
        return all > 0 ? detail / all : 0;
    }
    float kept_pixel(std::size_t i) const {
        float noise, errors;
        if (views[i] > 0) {
            const float around = Tuning::mean_over_geometric * std::exp(log_difference[i] / compared[i]);
            noise = std::max(around, own_difference[i]) / (views[i] + 1); // one view's firefly is not a lamp
            errors = Tuning::standard_errors;
        } else {
            noise = Tuning::mean_over_geometric_alone * std::exp(log_own[i]);
            errors = Tuning::standard_errors_alone;
        }
        const float limit = errors * errors * noise;
        return stands_out[i] > limit ? 1 - limit / stands_out[i] : 0;
    }

    Values shared, difference, of_noisy, log_difference, log_own,
        compared; // the last one is 1 if another view shows the pixel, otherwise 0
    Values stands_out, own_difference, views;
};

} // namespace

AveragedLayer averaged(const DenoisedLayer &view, double scale) {
    AveragedLayer means{view.noisy, view.denoised};
    const Grid &grid = view.grid;
    parallel_for(std::size_t(grid.height()), [&](std::size_t row) {
        std::vector<std::size_t> beside;
        const std::size_t first = row * std::size_t(grid.width());
        for (std::size_t i = first; i < first + std::size_t(grid.width()); ++i) {
            same_surface_beside(view, i, scale, beside);
            const float share = 1 / float(beside.size());
            for (const auto &[from, to] :
                 {std::pair(&view.noisy, &means.noisy), std::pair(&view.denoised, &means.denoised)})
                for (std::size_t c = 0; c < from->size(); ++c) {
                    float sum = 0;
                    for (const std::size_t k : beside) sum += (*from)[c][k];
                    (*to)[c][i] = share * sum;
                }
        }
    });
    return means;
}

Values kept_details(std::span<const DenoisedLayer> views, std::span<const AveragedLayer> means,
                    std::size_t at, double scale) {
    const DenoisedLayer &view = views[at];
    const Comparison comparison(views, means, at, scale);
    Planes planes(view.grid.size());
    const auto width = std::size_t(view.grid.width());
    parallel_for(std::size_t(view.grid.height()), [&](std::size_t row) {
        for (std::size_t i = row * width; i < (row + 1) * width; ++i)
            planes.set(i, view.z[i] > 0 ? comparison.of_pixel(i) : Evidence{},
                       seen(brightness(view.denoised, i)));
    });
    planes.average(view.grid);
    Values kept(view.grid.size());
    parallel_ranges(kept.size(), std::size_t(1) << 14, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) kept[i] = planes.kept(i);
    });
    return kept;
}

} // namespace sparselens
