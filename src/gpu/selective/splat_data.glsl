// The data of the selective gather's kernel: bindings (selective_tiles.cpp), and what a work group shares.

layout(binding = 0) readonly buffer Discs { double discs[]; };             // [x, y, radius][splat]
// [splat]: coverage, known, colours, known times radius
layout(binding = 1) readonly buffer SplatValues { float splat_values[]; };
layout(binding = 2) readonly buffer Pieces { Piece pieces[]; };
layout(binding = 3) readonly buffer Sums { double sums[]; };               // [block]: the same, divided by disc areas
layout(binding = 4) readonly buffer Lists { uint lists[]; };               // what a tile visits, front to back
layout(binding = 5) readonly buffer Cuts { uint cuts[]; };                 // [tile][pass]: where the pass begins in them
layout(binding = 6) readonly buffer Tiles { Tile tiles[]; };
// Kept between passes: [tile][group], then [layer][sum][pixel], [layer][pixel], [count, last bin][pixel], and
// [sum][pixel] followed by what all pixels of the tile get.
layout(binding = 7) buffer Layers { double layers[]; };
layout(binding = 8) buffer Gaps { int gaps[]; };
layout(binding = 9) buffer States { int states[]; };
layout(binding = 10) buffer Running { double running[]; };
layout(binding = 11) writeonly buffer Values { vec4 values[]; }; // [group][tile][pixel]
layout(binding = 12) writeonly buffer Alphas { float alphas[]; }; // [tile][pixel]
layout(push_constant) uniform Pushed { Push push; };
layout(constant_id = 0) const uint colours = 0; // of a splat
const uint value_size = colours + 3;

// The splats of a chunk.
shared dvec4 disc[chunk];              // x, y, radius, 1 / area
shared ivec4 touched[chunk];           // rows, then columns of the tile: the first, and the one after the last
shared double column_chord[chunk * edges]; // half the chord along each edge between columns,
shared double row_chord[chunk * edges];    // and between rows
shared uint touching[threads];             // [strip][half of the chunk]: one bit per splat
shared vec3 share[chunk];
shared vec4 colour[chunk];

struct Bin {
    double coverage, known, radius;
    dvec4 light;
};

// State of the work group and of the thread.
Tile tile;
uint place;     // (tile, group)
uint group;
Bin bins[own];  // sums of the current bin
Bin uniform_;   // what all pixels get
int layer_count[own], last_bin[own];

uint thread() { return gl_LocalInvocationIndex; }
uint pixel_of(uint j) { return thread() + threads * j; }
ivec2 position_of(uint j) { return ivec2(pixel_of(j) % size, pixel_of(j) / size); } // in the tile
bool is_inside(ivec2 at) { return at.x <= tile.x_max - tile.x_min && at.y <= tile.y_max - tile.y_min; }
Bin no_sums() { return Bin(0, 0, 0, dvec4(0)); }
