// The data of the lens gather's kernel: bindings, shared memory, and the current lens point. All belong to one stripe
// (stripe.h).

// Samples. Data that change in a pull of focus are apart from data that do not.
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
// [group][tile][pixel]: 1 if anything is known, else 0
layout(binding = 9) writeonly buffer Knowns { float knowns[]; };
layout(binding = 10) readonly buffer Facets { uint facets[]; };  // three samples each
layout(binding = 11) readonly buffer Sets { uint sets[]; };      // [channel]: its ColourSet
layout(binding = 12) readonly buffer Columns { uint columns[]; };
layout(binding = 13) readonly buffer Holdouts { uint holdouts[]; };
layout(binding = 14) readonly buffer Cocs { float cocs[]; };   // move what is seen and what hides
layout(binding = 15) readonly buffer Alphas { float alphas[]; };
// the sample that each shows; solids come after all samples
layout(binding = 16) readonly buffer Solids { uint solids[]; };
// CoCs of what opaque samples show, such as an image in a mirror
layout(binding = 17) readonly buffer Shown { float shown[]; };
// kept between passes: [group][tile][pixel][light, weight]
layout(binding = 18) buffer Sums { vec4 sums[]; };
layout(push_constant) uniform Pushed { Push push; };

shared uint64_t front[2 * cells]; // keys of the nearest samples, then of the nearest images or fillers; 0: none
shared uint near_blocks[threads]; // the blocks that reach the quarter
shared uint near_count;
shared uint empty_count;
shared uint counts[pixels]; // of partial samples, then where the next one is listed
shared uint listed[chunk];
shared uint listed_count;

// State of the current quarter and lens point.
ivec2 corner; // in the tile
vec2 first;   // pixel
uint rules;   // of the tile
uint partial_first, partial_count; // of the quarter
uint held_out; // where the tile's part of holdouts[] begins
Lens lens;

uint thread() { return gl_LocalInvocationIndex; }

ivec2 pixel_of(uint j) { return ivec2((thread() + threads * j) % size, (thread() + threads * j) / size); }
uint cell_of(ivec2 pixel) { return uint((pixel.y + 1) * side + pixel.x + 1); }
