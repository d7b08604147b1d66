// The weight of a pixel in the disc of a splat: PsfRows of src/lens/psf.cpp for one pixel instead of rows, with the
// same sums in the same order.

ivec2 columns_within(double centre, double distance_) {
    return ivec2(first_within(centre, distance_, tile.x_min, tile.x_max + 1), end_within(centre, distance_, tile.x_min, tile.x_max + 1));
}

// The rows and columns of the tile that the disc touches.
ivec4 touched_by(dvec3 d) {
    const bool point = d.z < smallest_psf_radius;
    const double radius = point ? 0 : d.z;
    precise const double high = radius * push.pixel_aspect;
    const ivec2 columns = columns_within(d.x, radius);
    ivec2 rows = ivec2(first_within(d.y, high, tile.y_min, tile.y_max + 1), end_within(d.y, high, tile.y_min, tile.y_max + 1));
    if (columns.x >= columns.y || d.x + d.z < tile.x_min || d.x - d.z > tile.x_max + 1) rows.y = rows.x;
    return ivec4(rows, columns);
}

double chord_at(uint s, int edge, Band band) {
    return clamp(column_chord[s * edges + uint(edge - tile.x_min)], band.low, band.high);
}

// Adds what the arc cuts off column x, outwards of `first`. direction 1: to the right.
void add_arc(inout double weight, uint s, Band band, int x, int first, int direction) {
    const dvec4 d = disc[s];
    const int before = direction > 0 ? x : x + 1, after = before + direction;
    precise const double begins = direction * (before - d.x), ends = direction * (after - d.x);
    const bool at_edge = x != first || begins > band.inner;
    const double from_x = at_edge ? begins : band.inner, from_y = at_edge ? chord_at(s, before, band) : band.high;
    if (from_x >= band.outer) return;
    const double to_x = min(ends, band.outer), to_y = chord_at(s, after, band);
    precise const double sum = weight + d.w * area_under(from_x, from_y, to_x, to_y, band.low, d.z);
    weight = sum;
}

void add_band(inout double weight, uint s, Band band, int x) {
    const dvec4 d = disc[s];
    const ivec2 all = touched[s].zw, columns = columns_within(d.x, band.inner);
    precise const double height = d.w * (band.high - band.low), left = d.x - band.inner, right = d.x + band.inner;
    if (x >= columns.x && x < columns.y) {
        precise const double part = min(x + 1.0lf, right) - max(double(x), left);
        precise const double sum = weight + height * (x == columns.x || x == columns.y - 1 ? part : 1.0lf);
        weight = sum;
    }
    const int to_right = max(columns.y - 1, all.x), to_left = min(columns.x, all.y - 1);
    // Most pixels meet only one of the arcs to the right and to the left, which are added in this order.
    const bool met_right = right < all.y && x >= to_right, met_left = left > all.x && x <= to_left;
    for (int side = met_right ? 0 : 1; side < (met_left ? 2 : 1); ++side)
        add_arc(weight, s, band, x, side == 0 ? to_right : to_left, side == 0 ? 1 : -1);
}

// The weight of splat s of the chunk in the pixel at (x, y), which it touches.
double weight_of(uint s, int x, int y) {
    const dvec4 d = disc[s];
    precise const double top = (y - d.y) / push.pixel_aspect, bottom = (y + 1 - d.y) / push.pixel_aspect;
    const uint row = s * edges + uint(y - tile.y_min);
    const double at_top = row_chord[row], at_bottom = row_chord[row + 1];
    const bool point = d.z < smallest_psf_radius, above = top < 0, below = bottom > 0;
    double weight = point ? 1 : 0;
    // The row that holds the centre has two bands: above the centre, and below.
    for (int side = above ? 0 : 1; side < (point ? 0 : below ? 2 : 1); ++side) {
        add_band(weight, s, band_of(side == 0, top, bottom, at_top, at_bottom, d.z), x);
    }
    return weight;
}

// Finds which splats of the chunk touch each strip of a row. A thread looks at half of the chunk for one strip.
void find_touching(uint count) {
    const uint strip = thread() / 2, first = thread() % 2 * (chunk / 2);
    const ivec2 at = ivec2(strip % strips * strip_size + tile.x_min, strip / strips + tile.y_min);
    uint found = 0;
    for (uint s = first; s < min(count, first + chunk / 2); ++s) {
        const ivec4 t = touched[s];
        if (at.y >= t.x && at.y < t.y && at.x + strip_size > t.z && at.x < t.w) found |= 1u << s;
    }
    touching[thread()] = found;
}

// Whether a splat has colour k of the group, and where among its values.
bool has_colour(uint k) { return 4 * group + k < colours; }
uint colour_at(uint k) { return 2 + 4 * group + k; }

// Brings `count` splats into shared memory. Begins and ends with a barrier.
void load_chunk(uint begin, uint count) {
    barrier();
    if (thread() < count) {
        const uint i = begin + thread(), at = i * value_size;
        const dvec3 d = dvec3(discs[i], discs[push.splat_count + i], discs[2 * push.splat_count + i]);
        precise const double area_to_weight = 1 / (pi * d.z * d.z);
        disc[thread()] = dvec4(d, area_to_weight);
        touched[thread()] = touched_by(d);
        share[thread()] = vec3(splat_values[at], splat_values[at + 1], splat_values[at + value_size - 1]);
        for (uint k = 0; k < 4; ++k) colour[thread()][k] = has_colour(k) ? splat_values[at + colour_at(k)] : 0;
    }
    barrier();
    for (uint e = thread(); e < 2 * count * edges; e += threads) {
        const uint n = e / 2, s = n / edges;
        const int edge = int(n % edges);
        const dvec4 d = disc[s];
        precise const double across = abs(edge + tile.x_min - d.x), down = abs(edge + tile.y_min - d.y) / push.pixel_aspect;
        if (e % 2 == 0) column_chord[n] = half_chord(d.z, across);
        else row_chord[n] = half_chord(d.z, down);
    }
    find_touching(count);
    barrier();
}

// Makes layers of bins, and the picture of layers: the same as src/dof/selective/splats.cpp, with the same sums in the
// same order.

// A layer of pixel j of the thread: coverage, what is known, and the light.
struct Layer {
    double coverage, known;
    dvec4 light;
};

uint gap_at(uint j, uint layer) { return (place * (push.limit + 1) + layer) * pixels + pixel_of(j); }
uint sum_at(uint j, uint layer, uint sum) {
    return ((place * (push.limit + 1) + layer) * layer_sums + sum) * pixels + pixel_of(j);
}

Layer layer_of(uint j, uint layer) {
    const uint at = sum_at(j, layer, 0);
    return Layer(layers[at], layers[at + pixels],
                 dvec4(layers[at + 2 * pixels], layers[at + 3 * pixels], layers[at + 4 * pixels], layers[at + 5 * pixels]));
}

void set_layer(uint j, uint layer, Layer to) {
    const uint at = sum_at(j, layer, 0);
    layers[at] = to.coverage;
    layers[at + pixels] = to.known;
    layers[at + 2 * pixels] = to.light.x;
    layers[at + 3 * pixels] = to.light.y;
    layers[at + 4 * pixels] = to.light.z;
    layers[at + 5 * pixels] = to.light.w;
}

Layer sum_of(Layer a, Layer b) {
    precise const double coverage = a.coverage + b.coverage, known = a.known + b.known;
    precise const dvec4 light = a.light + b.light;
    return Layer(coverage, known, light);
}

void merge_closest(uint j) {
    uint closest = 1;
    const uint count = uint(layer_count[j]);
    for (uint i = 2; i < count; ++i)
        if (gaps[gap_at(j, i)] < gaps[gap_at(j, closest)]) closest = i;
    set_layer(j, closest - 1, sum_of(layer_of(j, closest - 1), layer_of(j, closest)));
    for (uint i = closest + 1; i < count; ++i) {
        set_layer(j, i - 1, layer_of(j, i));
        gaps[gap_at(j, i - 1)] = gaps[gap_at(j, i)];
    }
    --layer_count[j];
}

// Adds a bin's sums, times `scale`, to the layers of pixel j.
void add_layer(uint j, int bin, Bin sums_, double scale) {
    precise const double coverage = scale * sums_.coverage, known = scale * sums_.known;
    precise const dvec4 light = scale * sums_.light;
    const Layer added = Layer(coverage, known, light);
    const uint count = uint(layer_count[j]);
    if (count > 0 && joins_layer(bin, last_bin[j])) {
        set_layer(j, count - 1, sum_of(layer_of(j, count - 1), added));
    } else {
        set_layer(j, count, added);
        gaps[gap_at(j, count)] = bin - last_bin[j];
        ++layer_count[j];
        if (count + 1 > push.limit) merge_closest(j);
    }
    last_bin[j] = bin;
}

double window_share_at(ivec2 at, double radius) {
    return window_share(push.data_x_min, push.data_y_min, push.data_x_max, push.data_y_max, push.pixel_aspect, at.x, at.y, radius);
}

void finish_bin(int bin) {
    for (uint j = 0; j < own; ++j) {
        const ivec2 at = position_of(j);
        precise const double coverage = bins[j].coverage + uniform_.coverage, known = bins[j].known + uniform_.known,
                             radius = bins[j].radius + uniform_.radius;
        precise const dvec4 light = bins[j].light + uniform_.light;
        if (is_inside(at) && known > least_known) {
            precise const double scale = 1 / window_share_at(ivec2(tile.x_min, tile.y_min) + at, radius / known);
            add_layer(j, bin, Bin(coverage, known, radius, light), scale);
        }
        bins[j] = no_sums();
    }
    uniform_ = no_sums();
}

// Goes from back to front, so that at each layer `known` is the sum over this layer and the layers behind it.
void blend(uint j, uint t) {
    dvec4 light = dvec4(0);
    double alpha = 0, known = 0;
    for (int i = layer_count[j] - 1; i >= 0; --i) {
        const Layer layer = layer_of(j, uint(i));
        precise const double more = known + layer.known;
        known = more;
        if (layer.coverage <= 0) continue;
        const double part = layer_share(layer.coverage, known);
        for (int k = 0; k < 4; ++k) light[k] = over(part, layer.light[k] / layer.coverage, light[k]);
        alpha = over(part, 1, alpha);
    }
    values[(group * push.tile_count + t) * pixels + pixel_of(j)] = vec4(light);
    if (group == 0) alphas[t * pixels + pixel_of(j)] = float(alpha);
}
