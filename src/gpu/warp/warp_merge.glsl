// What the samples of a surface become, as emit() of src/warp/warp.cpp has it.

struct Mean {
    double weights, dx, dy, inverse_z; // weights: the sum of those that count in it
    double merged;                     // view samples in it
};

// ViewMapping::in_view(). False: behind the camera of the view.
bool in_view(View view, double x, double y, double inverse_z, out double seen_x, out double seen_y) {
    precise const double scale = view.unzoom - view.approach * inverse_z;
    precise const double at_x = (x - view.offset_x - view.step_x * inverse_z) / scale,
                         at_y = (y - view.offset_y - view.step_y * inverse_z) / scale;
    seen_x = at_x;
    seen_y = at_y;
    return scale > 0;
}

bool lies_in(View view, double x, double y) {
    return x >= double(view.min_x) && x < double(view.max_x) + 1.0lf && y >= double(view.min_y) &&
           y < double(view.max_y) + 1.0lf;
}

// Where begins[] has the pixel of a view that holds a position in its data window; `none`: that row is not there, though
// the host sees to it that it is.
uint begin_at(View view, double x, double y) {
    const int row = int(floor(y)) - view.first_row;
    if (row < 0 || row >= view.rows) return none;
    return view.begins + uint(row * (view.max_x - view.min_x + 1) + int(floor(x)) - view.min_x);
}

// As src/warp/balance.h has it.
bool is_missing(View view, double x, double y, double inverse_z) {
    double seen_x, seen_y;
    if (!in_view(view, x, y, inverse_z, seen_x, seen_y)) return false;
    precise const double towards_x = seen_x * view.unzoom + view.offset_x, towards_y = seen_y * view.unzoom + view.offset_y;
    if (!lies_in(views[0], towards_x, towards_y)) return false;
    if (!lies_in(view, seen_x, seen_y)) return true;
    const uint at = begin_at(view, seen_x, seen_y);
    return at == none || begins[at] == begins[at + 1];
}

bool some_view_is_missing(ivec2 pixel, uint from, uint to) {
    const uvec4 first = landed[from];
    precise const double x = double(pixel.x) + 0.5lf + x_of(first), y = double(pixel.y) + 0.5lf + y_of(first);
    uint i = from; // views come in order, the centre's samples first
    while (i < to && marks[i].x == 0) ++i;
    for (uint v = 1; v < frame.views; ++v) {
        if (i < to && marks[i].x == v)
            while (i < to && marks[i].x == v) ++i;
        else if (is_missing(views[v], x, y, inverse_z_of(first))) return true;
    }
    return false;
}

// By what weights are changed where views of a surface are missing: see balanced_weight(). 0: not at all.
dvec2 balance_of(uint pixel, uint from, uint to) {
    if (marks[from].x != 0 || to - from == 1 || !some_view_is_missing(position_of(pixel), from, to)) return dvec2(0);
    precise double xx = 1.0lf / 64.0lf, xy = 0, yy = xx, x = 0, y = 0; // gradient_to_noise is 8
    for (uint i = from; i < to; ++i) {
        const double weight = weight_of(landed[i]), dx = x_of(landed[i]), dy = y_of(landed[i]);
        xx = xx + weight * dx * dx;
        xy = xy + weight * dx * dy;
        yy = yy + weight * dy * dy;
        x = x + weight * dx;
        y = y + weight * dy;
    }
    precise const double determinant = xx * yy - xy * xy;
    precise const double by_x = (yy * x - xy * y) / determinant, by_y = (xx * y - xy * x) / determinant;
    return dvec2(by_x, by_y);
}

double balanced_weight(uvec4 fallen, dvec2 balance) {
    precise const double share = 1.0lf - x_of(fallen) * balance.x - y_of(fallen) * balance.y;
    precise const double weight = weight_of(fallen) * (share < 0.01lf ? 0.01lf : share);
    return weight;
}

Mean mean_of(uint from, uint to, dvec2 balance) {
    precise double merged = 0, total = 0, dx = 0, dy = 0, inverse_z = 0;
    for (uint i = from; i < to; ++i) {
        const uvec4 fallen = landed[i];
        const double weight = balanced_weight(fallen, balance);
        merged = merged + double(weights[fallen.x]);
        total = total + weight;
        dx = dx + weight * x_of(fallen);
        dy = dy + weight * y_of(fallen);
        inverse_z = inverse_z + weight * inverse_z_of(fallen);
    }
    dx = dx / total;
    dy = dy / total;
    inverse_z = inverse_z / total;
    return Mean(total, dx, dy, inverse_z, merged);
}

bool block_may_average(uint pixel) {
    const int columns = (frame.width + block_size - 1) / block_size;
    const int x = int(pixel) % frame.width, y = int(pixel) / frame.width;
    return (verdicts[y / block_size * columns + x / block_size] & may_average) != 0;
}

// Whether the surface that begins at `from` is the centre's sample alone.
bool stays_alone(uint pixel, uint from) {
    return !has_rule(averages) || (marks[from].x == 0 && !block_may_average(pixel));
}
