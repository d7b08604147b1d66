// What the kernel of the lens gather works on: bindings, shared memory, and the lens point at hand. All of a stripe
// (stripe.h).

const uint threads = 256;
const int size = 32;             // pixels a quarter is wide and high
const int side = size + 2;       // with the cells next to it, where cracks are looked for
const uint cells = side * side;
const uint pixels = size * size; // threads * own
const uint own = 4;              // pixels of a thread
const uint chunk = 512;          // partial samples at once
const int tile_stride = 68;      // of LensTile, as its projection clamps to it
const int tile_border = 2;
const uint none = 0xffffffffu;
const float covered_at_all = 1 - 1.0 / 16777216;
const float one_surface_px = 0.5;
const float side_by_side = 1.5;

struct Block {
    uint begin, opaque_end;
    float x_min, x_max, y_min, y_max, coc_min, coc_max;
};
struct Lens {
    float x, y, pixel_x, pixel_y, weight;
    float red, green, blue, behind, in_front; // by what the weight is multiplied
    float weight_before; // of the tile's lens points before it
};
struct Tile {
    float x, y;                  // of its first pixel
    uint blocks, block_count;    // among block_lists
    uint fillers, filler_count;  // among block_lists
    uint partial[4], partial_count[4]; // of each quarter, among partial_lists
    uint lens, lens_count;
    uint lens_in_pass;           // so many at most
    uint facets, facet_count;    // blocks of them, among block_lists
    uint rules;                  // a set of the following
    uint columns;                // see seen_through(), among columns[]
    uint holdout;                // see passes(), among holdouts[]
};
const uint weighted = 1;  // lens points weigh differently for colours or sides of the focus, or not all pixels see through
const uint two_sided = 2; // they do for sides of the focus
const uint images = 4;    // mirrors or glass reach the tile
const uint cat_eye = 8;   // not all pixels see through a lens point
const uint darkens = 16;  // and that takes light from the pixels
const uint holdout = 32;  // a holdout stays sharp


// Of samples, apart from each other what changes in a pull of focus and what does not.
layout(binding = 0) readonly buffer Places { vec2 places[]; };
// The upper half of the key: 1 for a background, else the bits of the perceptive depth, plus 2.
layout(binding = 1) readonly buffer Uppers { uint uppers[]; };
layout(binding = 2) readonly buffer Colours { vec4 colours[]; }; // [group][sample]
layout(binding = 3) readonly buffer Blocks { Block blocks[]; };
layout(binding = 4) readonly buffer BlockLists { uint block_lists[]; };
layout(binding = 5) readonly buffer PartialLists { uint partial_lists[]; }; // front to back
layout(binding = 6) readonly buffer LensPoints { Lens lens_points[]; };
layout(binding = 7) readonly buffer Tiles { Tile tiles[]; };
layout(binding = 8) writeonly buffer Values { vec4 values[]; }; // [group][tile][pixel of the tile]
layout(binding = 9) writeonly buffer Knowns { float knowns[]; }; // [group][tile][pixel]: 1 where anything is known, else 0
layout(binding = 10) readonly buffer Facets { uint facets[]; };  // three samples each
layout(binding = 11) readonly buffer Sets { uint sets[]; };      // [channel]: its ColourSet
layout(binding = 12) readonly buffer Columns { uint columns[]; };
layout(binding = 13) readonly buffer Holdouts { uint holdouts[]; };
layout(binding = 14) readonly buffer Cocs { float cocs[]; };   // by which they are seen and hide
layout(binding = 15) readonly buffer Alphas { float alphas[]; };
layout(binding = 16) readonly buffer Shown { float shown[]; }; // CoCs of what opaque ones show, be it an image in a mirror
layout(binding = 17) buffer Sums { vec4 sums[]; }; // from one pass to the next: [group][tile][pixel][light, weight]
layout(push_constant) uniform Push {
    uint first_tile, tile_count, sample_count, first_filler, pass;
    float depth_at_1; // perceptive depth at z = 1
};
const uint red = 1, green = 2, blue = 4, data = 16; // ColourSet

shared uint64_t front[2 * cells]; // keys of the nearest samples, then of the nearest images or fillers; 0: none
shared uint near_blocks[threads]; // those that reach the quarter
shared uint near_count;
shared uint empty_count;
shared uint counts[pixels]; // of partial samples, then where the next one is listed
shared uint listed[chunk];
shared uint listed_count;

// Of the quarter and the lens point at hand.
ivec2 corner; // in the tile
vec2 first;   // pixel
uint rules;   // of the tile
uint partial_first, partial_count; // of the quarter
uint held_out; // where holdouts[] has the tile's
Lens lens;

uint thread() { return gl_LocalInvocationIndex; }

float depth_of(uint upper) { return upper < 2 ? 0 : uintBitsToFloat(upper - 2); }
uint64_t key_of(uint upper, uint sample_) { return (uint64_t(upper) << 32) | uint64_t(sample_); }
uint upper_of(uint64_t key) { return uint(key >> 32); }
uint sample_of(uint64_t key) { return uint(key & 0xffffffffUL); }

ivec2 pixel_of(uint j) { return ivec2((thread() + threads * j) % size, (thread() + threads * j) / size); }
uint cell_of(ivec2 pixel) { return uint((pixel.y + 1) * side + pixel.x + 1); }
