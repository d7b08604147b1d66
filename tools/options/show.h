// The option --show: a picture in false colours (dof/false_colour.h) of what the tool understood, in place of the
// gathered one.
#pragma once

#include "deep/ldi.h"
#include "dof/lens/lens_tiles.h"
#include "harness/commands/cli.h"

namespace sparselens {

struct ThinLens;

enum class Show { picture, coc, focus, layers, tiles };

void add_show_option(CLI::App &app, Show &show);

inline bool needs_gather(Show show) { return show == Show::picture || show == Show::tiles; }

// The false colours over `window`. `tiles` is what the gather chose, empty where nothing was gathered.
Image shown(Show show, const Ldi &ldi, const ThinLens &lens, const Imath::Box2i &window, LensTiles tiles);

} // namespace sparselens
