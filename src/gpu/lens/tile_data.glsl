// The data of the lens gather's kernel: bindings, shared memory, and the state of a work group.

// The scene (lens_tiles.h). Data that change in a pull of focus are apart from data that do not.
layout(binding = 0) readonly buffer Places { vec2 places[]; };
// With the bit `hiding` except for fillers.
layout(binding = 1) readonly buffer Uppers { uint uppers[]; };
layout(binding = 2) readonly buffer Cocs { float cocs[]; }; // move what is seen and what hides
// CoCs of what opaque samples show, such as an image in a mirror
layout(binding = 3) readonly buffer Shown { float shown[]; };
layout(binding = 4) readonly buffer Alphas { float alphas[]; };
layout(binding = 5) readonly buffer Colours { vec4 colours[]; }; // [group][sample]
// the sample that each shows; solids come after all samples
layout(binding = 6) readonly buffer Solids { uint solids[]; };
layout(binding = 7) readonly buffer Facets { uint facets[]; }; // three samples each
layout(binding = 8) readonly buffer Blocks { Block blocks[]; };
layout(binding = 9) readonly buffer Sets { uint sets[]; }; // [channel]: its ColourSet
// The stripe of tiles (tile_lists.h).
layout(binding = 10) readonly buffer BlockLists { uint block_lists[]; };
layout(binding = 11) readonly buffer PartialLists { uint partial_lists[]; }; // front to back
layout(binding = 12) readonly buffer LensPoints { Lens lens_points[]; };
layout(binding = 13) readonly buffer Columns { uint columns[]; };
layout(binding = 14) readonly buffer Holdouts { uint holdouts[]; };
layout(binding = 15) readonly buffer Tiles { Tile tiles[]; };
layout(binding = 16) writeonly buffer Values { vec4 values[]; }; // [group][tile][pixel of the tile]
// [group][tile][pixel]: 1 if anything is known, else 0
layout(binding = 17) writeonly buffer Knowns { float knowns[]; };
// kept between passes: [group][tile][pixel][light, weight]
layout(binding = 18) buffer Sums { vec4 sums[]; };
layout(push_constant) uniform Pushed { Push push; };

// The rules that the tiles need are known when the pipeline is made: the others leave nothing behind in it.
layout(local_size_x_id = 0) in;
layout(constant_id = 0) const uint workers = 256; // of a work group
layout(constant_id = 1) const uint points = 4;    // of the lens, at once
layout(constant_id = 2) const uint rules = 0;
const bool is_weighted = (rules & weighted) != 0, is_two_sided = (rules & two_sided) != 0,
           has_images = (rules & images) != 0, has_cat_eye = (rules & cat_eye) != 0,
           has_holdout = (rules & holdout) != 0;
const uint own = pixels / workers;             // pixels of a thread
const uint rows = workers / size;              // of pixels that threads own side by side
const uint images_from = points * cells;       // in front[]
const uint fronts = images_from + (rules & images) / images * images_from;

// [lens point][cell]: words of the nearest samples (dof/lens/tile_samples.h), with the bit `hiding`, and without it of
// fillers where there are none; 0: nothing. Then the same of the nearest images, and later of what each cell shows.
shared uint front[fronts];
shared uvec3 near[workers]; // the samples of the blocks that reach the quarter: begin, end, number of the first
shared uint near_count;
// Partial samples in front of the pixels of each thread, as a chain of entries: [thread] the first, [entry] the next.
shared uint chains[workers], nexts[chunk * points];

// State of the current quarter and lens points.
ivec2 corner; // in the tile
vec2 first;   // pixel
uint partial_first, partial_count; // of the quarter
uint held_out; // where the tile's part of holdouts[] begins
uint first_lens, first_column; // of the lens points
vec4 eyes[points]; // where each lens point looks from: x, y on the lens, x, y in the pixel
ivec4 whole_eyes[points]; // the same in units of the tile
TileUnits units;
uint number_bits; // of a word
uint runs, run_count, numbers; // among the lists of blocks

struct Sum {
    vec4 light;
    vec4 weight; // the known weight of each channel; without the rule `weighted`, x: the unknown weight
};
Sum sum[own]; // of the thread's pixels, over the lens points so far

uint thread() { return gl_LocalInvocationIndex; }
// A pixel's owner is the thread that adds to it.
ivec2 pixel_of(uint j) {
    const uint y = j * rows + thread() / size;
    return ivec2((thread() + turn * y) % size, y);
}
uint owner_of(uvec2 pixel) { return pixel.y % rows * size + (pixel.x - turn * pixel.y) % size; }
uint cell_of(uint l, ivec2 pixel) { return l * cells + uint((pixel.y + 1) * side + pixel.x + 1); }

// Numbers of samples in words.

uint word_of(uint code, uint number) { return hiding | code << number_bits | number; }
uint number_mask() { return (1u << number_bits) - 1; }
uint number_of(uint word) { return word & number_mask(); }
uint code_of(uint word) { return (word & ~hiding) >> number_bits; }
uint number_of_sample(uint sample_) {
    uint low = 0; // of the runs, the last that begins at most at the sample
    for (uint high = run_count; high - low > 1;) {
        const uint middle = (low + high) / 2;
        if (block_lists[runs + 2 * middle] <= sample_) low = middle;
        else high = middle;
    }
    return block_lists[runs + 2 * low + 1] - (sample_ - block_lists[runs + 2 * low]);
}
uint sample_of(uint word) { return block_lists[numbers + number_of(word)]; }
uint sample_at(uint cell) { return sample_of(front[cell]); }
float depth_in(uint sample_) { return depth_of(uppers[sample_] & ~hiding); }
uint code_in(uint sample_) { return depth_code(uppers[sample_] & ~hiding, units.nearest, units.codes); }
