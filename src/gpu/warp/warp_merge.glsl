// Merges the samples of a surface, like emit() of src/warp/warp.cpp.

// Like ViewMapping::in_view(). Returns false behind the camera of the view.
bool in_view(View view, double x, double y, double inverse_z, out double seen_x, out double seen_y) {
    const double scale = scale_in_view(view.unzoom, view.approach, inverse_z);
    seen_x = place_in_view(x, view.offset_x, view.step_x, inverse_z, scale);
    seen_y = place_in_view(y, view.offset_y, view.step_y, inverse_z, scale);
    return scale > 0;
}

bool lies_in(View view, double x, double y) {
    return lies_in(x, view.min_x, view.max_x) && lies_in(y, view.min_y, view.max_y);
}

uint begin_at(View view, double x, double y) { return begin_at(view, int(floor(x)), int(floor(y))); }

// Like is_missing() of src/warp/coverage.h.
bool is_missing(View view, double x, double y, double inverse_z) {
    double seen_x, seen_y;
    if (!in_view(view, x, y, inverse_z, seen_x, seen_y)) return false;
    const double towards_x = at_infinity(seen_x, view.unzoom, view.offset_x),
                 towards_y = at_infinity(seen_y, view.unzoom, view.offset_y);
    if (!lies_in(views[0], towards_x, towards_y)) return false;
    if (!lies_in(view, seen_x, seen_y)) return true;
    const uint at = begin_at(view, seen_x, seen_y);
    return begins[at] == begins[at + 1];
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

// How weights change where views of a surface are missing: see balanced_weight(). 0: not at all.
dvec2 balance_of(uint pixel, uint from, uint to) {
    if (marks[from].x != 0 || to - from == 1 || !some_view_is_missing(position_of(pixel), from, to)) return dvec2(0);
    Offsets offsets = no_offsets();
    for (uint i = from; i < to; ++i) add_offset(offsets, weight_of(landed[i]), x_of(landed[i]), y_of(landed[i]));
    return dvec2(balance_x(offsets), balance_y(offsets));
}

double balanced_weight(uvec4 fallen, dvec2 balance) {
    precise const double weight = weight_of(fallen) * balanced_share(x_of(fallen), y_of(fallen), balance.x, balance.y);
    return weight;
}

Mean mean_of(uint from, uint to, dvec2 balance) {
    Mean mean = Mean(0, 0, 0, 0, 0, 0);
    for (uint i = from; i < to; ++i) {
        const uvec4 fallen = landed[i];
        add_to_mean(mean, balanced_weight(fallen, balance), double(weights[fallen.x]), x_of(fallen), y_of(fallen),
                    inverse_z_of(fallen), alpha_of(fallen.x));
    }
    divide_mean(mean);
    return mean;
}

bool block_may_average(uint pixel) {
    const int columns = (frame.width + photo_block - 1) / photo_block;
    const int x = int(pixel) % frame.width, y = int(pixel) / frame.width;
    return (verdicts[y / photo_block * columns + x / photo_block] & may_average) != 0;
}

// Whether the surface that begins at `from` is the centre's sample alone.
bool stays_alone(uint pixel, uint from) {
    return !has_rule(averages) || (marks[from].x == 0 && !block_may_average(pixel));
}
