#include "options/show.h"

#include "dof/false_colour.h"
#include "harness/words.h"

#include <CLI/CLI.hpp>

namespace sparselens {

void add_show_option(CLI::App &app, Show &show) {
    const std::map<std::string, Show> shows{
        {"coc", Show::coc}, {"focus", Show::focus}, {"layers", Show::layers}, {"tiles", Show::tiles}};
    app.add_option(
           "--show", show,
           "Write false colours instead of the picture. coc: circle of confusion; focus: what is in focus; "
           "layers: samples per pixel; tiles: lens points per tile, with --method lens")
        ->type_name("coc|focus|layers|tiles")
        ->transform(words(shows));
}

Image shown(Show show, const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window, LensTiles tiles) {
    switch (show) {
    case Show::coc: return crop(coc_colours(ldi, lens), window);
    case Show::focus: return crop(focus_colours(ldi, lens), window);
    case Show::layers: return crop(layer_colours(ldi), window);
    case Show::picture:
    case Show::tiles: break;
    }
    const Windows windows{ldi.windows.display, window, ldi.windows.pixel_aspect};
    if (tiles.lens_points.empty()) tiles = {std::max(windows.width(), windows.height()), 1, 1, {0}};
    return tile_colours(tiles, windows);
}

} // namespace sparselens
