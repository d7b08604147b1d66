#include "deep/packed_view.h"

namespace sparselens {

PackedView::PackedView(const View &view)
    : name(view.name), samples(view, view.image.channels), position(view.position), framing(view.framing) {}

PackedView::PackedView(View &&view)
    : name(std::move(view.name)), samples(std::move(view), view.image.channels), position(view.position),
      framing(view.framing) {}

std::vector<PackedView> referring_to(std::span<const View> views) { return {views.begin(), views.end()}; }

std::vector<PackedView> packed(std::vector<View> &&views) {
    std::vector<PackedView> taken;
    for (View &view : views) taken.emplace_back(std::move(view));
    return taken;
}

View unpacked(const PackedView &view) {
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
