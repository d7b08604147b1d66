// Makes layers of bins, and the picture of layers: the same as src/dof/selective/blend.cpp, with the same sums in the
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
