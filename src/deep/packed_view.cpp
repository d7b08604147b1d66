#include "deep/packed_view.h"

#include <cassert>
#include <utility>

namespace sparselens {

namespace {

bool is_flat(const Ldi &ldi) {
    for (std::size_t p = 0; p + 1 < ldi.begin.size(); ++p)
        if (ldi.pixel(p).size() > 1) return false;
    return ldi.z_back.empty() || ldi.z_back == ldi.z;
}

// A flat view. Pixels of depth 0 show nothing.
View flat_view(const std::string &name, const Ldi &ldi) {
    View view{name, Image(ldi.windows, ldi.channels), std::vector<float>(ldi.windows.pixels())};
    for (std::size_t p = 0; p < view.z.size(); ++p)
        for (const std::uint64_t i : ldi.pixel(p)) {
            view.z[p] = ldi.z[i];
            for (std::size_t k = 0; k < ldi.channels.size(); ++k) view.image.plane(k)[p] = ldi.values[k][i];
        }
    return view;
}

ViewSamples samples_of(const std::string &name, Ldi &&ldi) {
    if (!is_flat(ldi)) return ViewSamples(std::move(ldi));
    const std::vector<Channel> channels = ldi.channels;
    return {flat_view(name, std::exchange(ldi, {})), channels};
}

} // namespace

PackedView::PackedView(const View &view)
    : name(view.name), samples(view, view.image.channels), position(view.position), framing(view.framing) {}

PackedView::PackedView(View &&view)
    : name(std::move(view.name)), samples(std::move(view), view.image.channels), position(view.position),
      framing(view.framing) {}

PackedView::PackedView(std::string called, Ldi &&ldi)
    : name(std::move(called)), samples(samples_of(name, std::move(ldi))) {}

std::vector<PackedView> referring_to(std::span<const View> views) { return {views.begin(), views.end()}; }

std::vector<PackedView> packed(std::vector<View> &&views) {
    std::vector<PackedView> taken;
    for (View &view : views) taken.emplace_back(std::move(view));
    return taken;
}

View unpacked(const PackedView &view) {
    assert(!view.samples.deep());
    return {view.name,
            view.samples.image(),
            {view.samples.depths().begin(), view.samples.depths().end()},
            view.position,
            view.framing};
}

Camera place_views(std::span<PackedView> views, std::span<const StatedView> stated) {
    PlacedCameras placed = place_cameras(stated);
    for (std::size_t i = 0; i < views.size(); ++i) {
        const ViewPlace &place = placed.places[i];
        views[i].position = place.position;
        views[i].framing = place.framing;
        if (place.framing.forward != 0) views[i].samples.move_back(place.framing.forward);
    }
    return std::move(placed.centre);
}

} // namespace sparselens
