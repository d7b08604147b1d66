#include "denoised/denoised_views.h"

#include "base/channel_names.h"
#include "base/error.h"
#include "base/parallel.h"
#include "denoised/kept_details.h"

#include <fmt/format.h>

#include <algorithm>
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
    std::erase_if(kept, [&](const Channel &channel) { return channel.name.starts_with(noisy_layer + "."); });
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

} // namespace sparselens
