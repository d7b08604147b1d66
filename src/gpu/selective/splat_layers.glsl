// Bins become layers, and layers the picture: what src/dof/selective/blend.cpp says, with the same sums in the same order.

const double least_known = 1e-12lf;

// For 0 <= x <= 1; GLSL has none for double. The rational form of Sun's fdlibm; the error is below 1e-15.
double arc_sine(double x) {
    const bool small = x < 0.5lf;
    precise const double t = small ? x * x : (1 - x) * 0.5lf;
    precise const double above =
        t * (1.66666666666666657415e-01lf +
             t * (-3.25565818622400915405e-01lf +
                  t * (2.01212532134862925881e-01lf +
                       t * (-4.00555345006794114027e-02lf +
                            t * (7.91534994289814532176e-04lf + t * 3.47933107596021167570e-05lf)))));
    precise const double below =
        1 + t * (-2.40339491173441421878e+00lf +
                 t * (2.02094576023350569471e+00lf +
                      t * (-6.88283971605453293030e-01lf + t * 7.70381505559019352791e-02lf)));
    const double s = small ? x : sqrt(t);
    precise const double bent = s + s * (above / below);
    precise const double angle = small ? bent : pi / 2 - 2 * bent;
    return angle;
}

// Of sqrt(r^2 - t^2), from 0 to t.
double chord_integral(double radius, double t) {
    precise const double area = (t * half_chord(radius, t) + radius * radius * arc_sine(t / radius)) / 2;
    return area;
}

// As in src/lens/psf.cpp.
double signed_quadrant_area(double radius, double x, double y) {
    const double across = min(abs(x), radius), down = min(abs(y), radius);
    const double turned = (x < 0) == (y < 0) ? 1 : -1;
    precise const double squared = across * across + down * down, whole = radius * radius;
    precise const double box = turned * across * down;
    if (squared <= whole) return box;
    const double start = half_chord(radius, down);
    precise const double area = turned * (start * down + chord_integral(radius, across) - chord_integral(radius, start));
    return area;
}

// The part of a disc around a pixel that lies in the data window.
double window_share(ivec2 at, double radius) {
    precise const double high = radius * pixel_aspect;
    const double left = at.x + 0.5lf - data_min.x, right = data_max.x + 0.5lf - at.x, above = at.y + 0.5lf - data_min.y,
                 below = data_max.y + 0.5lf - at.y;
    if (left >= radius && right >= radius && above >= high && below >= high) return 1;
    precise const double x0 = data_min.x - (at.x + 0.5lf), x1 = data_max.x + 1 - (at.x + 0.5lf),
                         y0 = (data_min.y - (at.y + 0.5lf)) / pixel_aspect, y1 = (data_max.y + 1 - (at.y + 0.5lf)) / pixel_aspect;
    precise const double area = signed_quadrant_area(radius, x1, y1) - signed_quadrant_area(radius, x0, y1) -
                                signed_quadrant_area(radius, x1, y0) + signed_quadrant_area(radius, x0, y0);
    precise const double share_ = max(0.0lf, area) / (pi * radius * radius);
    return share_;
}

// A layer of pixel j of the thread: coverage, what is known, and the light.
struct Layer {
    double coverage, known;
    dvec4 light;
};

uint gap_at(uint j, uint layer) { return (place * (limit + 1) + layer) * pixels + pixel_of(j); }
uint sum_at(uint j, uint layer, uint sum) {
    return ((place * (limit + 1) + layer) * layer_sums + sum) * pixels + pixel_of(j);
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
    if (count > 0 && bin <= last_bin[j] + 1) {
        set_layer(j, count - 1, sum_of(layer_of(j, count - 1), added));
    } else {
        set_layer(j, count, added);
        gaps[gap_at(j, count)] = bin - last_bin[j];
        ++layer_count[j];
        if (count + 1 > limit) merge_closest(j);
    }
    last_bin[j] = bin;
}

void finish_bin(int bin) {
    for (uint j = 0; j < own; ++j) {
        const ivec2 at = position_of(j);
        precise const double coverage = bins[j].coverage + uniform_.coverage, known = bins[j].known + uniform_.known,
                             radius = bins[j].radius + uniform_.radius;
        precise const dvec4 light = bins[j].light + uniform_.light;
        if (is_inside(at) && known > least_known) {
            precise const double scale = 1 / window_share(ivec2(tile.x_min, tile.y_min) + at, radius / known);
            add_layer(j, bin, Bin(coverage, known, radius, light), scale);
        }
        bins[j] = no_sums();
    }
    uniform_ = no_sums();
}

// From back to front, so that `known` is at each layer what lies there or behind it.
void blend(uint j, uint t) {
    dvec4 light = dvec4(0);
    double alpha = 0, known = 0;
    for (int i = layer_count[j] - 1; i >= 0; --i) {
        const Layer layer = layer_of(j, uint(i));
        precise const double more = known + layer.known;
        known = more;
        if (layer.coverage <= 0) continue;
        precise const double part = min(1.0lf, layer.coverage / min(1.0lf, known));
        precise const dvec4 behind = part * (layer.light / layer.coverage) + (1 - part) * light;
        precise const double covered = part + (1 - part) * alpha;
        light = behind;
        alpha = covered;
    }
    values[(group * tile_count + t) * pixels + pixel_of(j)] = vec4(light);
    if (group == 0) alphas[t * pixels + pixel_of(j)] = float(alpha);
}
