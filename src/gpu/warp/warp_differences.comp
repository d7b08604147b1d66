#version 460
// Finds where the colours of rim views differ from the centre view's by more than noise, like find_photo_consistency()
// of src/warp/photo_consistency.cpp. One thread takes a block of pixels, and adds in the CPU's order.
#extension GL_GOOGLE_include_directive : require
#include "warp_data.glsl"

PhotoBlock shown;

uint begin_at(int x, int y) { return begin_at(views[0], x, y); }
bool single(int x, int y) { return begins[begin_at(x, y) + 1] - begins[begin_at(x, y)] == 1; }
double centre_value(int x, int y, uint channel) { return bounded(double(value_of(begins[begin_at(x, y)], channel))); }

bool plain(int x, int y) {
    const View centre = views[0];
    if (x <= centre.min_x || x >= centre.max_x || y <= centre.min_y || y >= centre.max_y) return false;
    return single(x, y) && single(x - 1, y) && single(x + 1, y) && single(x, y - 1) && single(x, y + 1);
}

double coc_at(double inverse_z) {
    if (!has_rule(focus_known)) return 2 * focus_px;
    precise const double z = 1.0lf / inverse_z;
    return abs(coc_of(frame.focus_scale, frame.focus, has_rule(focus_at_infinity), z, inverse_z == 0));
}

struct Detail {
    double value, mean_around, gradient_x, gradient_y;
};
Detail detail(int x, int y, uint channel) {
    const double left = centre_value(x - 1, y, channel), right = centre_value(x + 1, y, channel),
                 above = centre_value(x, y - 1, channel), below = centre_value(x, y + 1, channel);
    precise const double mean_around = (left + right + above + below) / 4.0lf;
    precise const double gradient_x = (right - left) / 2.0lf, gradient_y = (below - above) / 2.0lf;
    return Detail(centre_value(x, y, channel), mean_around, gradient_x, gradient_y);
}

void compare(int x, int y, uint from, uint to) {
    Detail own[3];
    precise double sum[3], total = 0;
    for (uint k = 0; k < frame.colours[3]; ++k) own[k] = detail(x, y, frame.colours[k]);
    for (uint k = 0; k < 3; ++k) sum[k] = 0;
    for (uint i = from; i < to; ++i) {
        if (marks[i].x == 0) continue;
        const uvec4 fallen = landed[i];
        const double weight = weight_of(fallen), dx = x_of(fallen), dy = y_of(fallen);
        const View view = views[marks[i].x];
        total = total + weight;
        precise const double motion_x = parallax(double(x) + 0.5lf, view.step_x, view.approach) * frame.inverse_scale,
                             motion_y = parallax(double(y) + 0.5lf, view.step_y, view.approach) * frame.inverse_scale;
        for (uint k = 0; k < frame.colours[3]; ++k) {
            const double value = bounded(double(value_of(fallen.x, frame.colours[k])));
            sum[k] = sum[k] + weight * value;
            precise const double moved = value - own[k].value - (own[k].gradient_x * dx + own[k].gradient_y * dy),
                                 change = own[k].gradient_x * motion_x + own[k].gradient_y * motion_y;
            add_motion(shown, moved, change);
        }
    }
    for (uint k = 0; k < frame.colours[3]; ++k) {
        precise const double apart = sum[k] / total - own[k].value, varied = own[k].mean_around - own[k].value;
        add_channel(shown, apart, varied);
    }
}

void look_at(uint pixel) {
    const uint first = first_of(pixel), end = ends[pixel];
    const ivec2 at = position_of(pixel);
    for (uint from = first, to; from < end && marks[from].y != none; from = to) {
        to = surface_end(from, end);
        if (marks[from].x != 0 || marks[to - 1].x == 0 || !plain(at.x, at.y)) continue;
        compare(at.x, at.y, from, to);
        add_pixel(shown, coc_at(means[first + marks[from].y]));
    }
}

void main() {
    const int columns = (frame.width + photo_block - 1) / photo_block, rows = (frame.height + photo_block - 1) / photo_block;
    const uint block = item();
    if (block >= uint(columns * rows)) return;
    const int left = int(block) % columns * photo_block, top = int(block) / columns * photo_block;
    shown = PhotoBlock(0, 0, 0, 0, 0, 0, 0, 0);
    for (int y = top; y < min(top + photo_block, frame.height); ++y)
        for (int x = left; x < min(left + photo_block, frame.width); ++x) look_at(uint(y * frame.width + x));
    verdicts[block] = photo_verdict(shown, frame.motion_unit);
}
