#version 460
// Writes the final samples of each pixel, one thread per pixel: means of surfaces, or the centre's sample.
#extension GL_GOOGLE_include_directive : require
#include "warp_data.glsl"
#include "warp_merge.glsl"

uint total; // samples of all pixels

void write(uint array, uint to, uint bits) { results[array * total + to] = bits; }
void write(uint array, uint to, float value) { write(array, to, floatBitsToUint(value)); }

// Writes the first sample of the centre view, else the most central sample, unchanged.
void emit_nearest(uint from, uint end, uint to) {
    uint best = from;
    float least = 0;
    for (uint i = from; i < end; ++i) {
        const float dx = float(x_of(landed[i])), dy = float(y_of(landed[i]));
        precise float off_centre = dx * dx + dy * dy;
        if (marks[i].x == 0) off_centre = -1;
        if (i == from || off_centre < least) {
            best = i;
            least = off_centre;
        }
    }
    const uvec4 fallen = landed[best];
    write(0, to, depths[fallen.x]);
    write(1, to, fallen.y);
    write(2, to, fallen.z);
    write(3, to, weights[fallen.x]);
    for (uint k = 0; k < frame.channels; ++k) write(4 + k, to, values[k * frame.samples + fallen.x]);
}

// Writes four channels at once, from `first` on. Ids are copied.
void emit_channels(uint first, uint from, uint end, dvec2 balance, double coverage, double total_weight, uint to) {
    const uint count = min(4, frame.channels - first);
    precise dvec4 sum = dvec4(0);
    for (uint i = from; i < end; ++i) {
        const double weight = balanced_weight(landed[i], balance);
        for (uint k = 0; k < count; ++k) sum[k] = sum[k] + weight * double(value_of(landed[i].x, first + k));
    }
    for (uint k = 0; k < count; ++k) {
        precise const double value = coverage * (sum[k] / total_weight);
        if (ids[first + k] != 0) write(4 + first + k, to, values[(first + k) * frame.samples + landed[from].x]);
        else write(4 + first + k, to, float(value));
    }
}

void emit_mean(uint pixel, uint from, uint end, double coverage, uint to) {
    const dvec2 balance = balance_of(pixel, from, end);
    const Mean mean = mean_of(from, end, balance);
    precise const double z = 1.0lf / mean.inverse_z;
    write(0, to, end - from == 1 ? depths[landed[from].x] : float(z));
    write(1, to, float(mean.dx));
    write(2, to, float(mean.dy));
    write(3, to, float(mean.merged));
    for (uint first = 0; first < frame.channels; first += 4)
        emit_channels(first, from, end, balance, coverage, mean.weights, to);
}

void main() {
    const uint pixel = item();
    if (pixel >= pixel_count()) return;
    total = emitted[pixel_count()];
    const uint first = first_of(pixel), end = ends[pixel];
    uint at = emitted[pixel];
    for (uint from = first, to; from < end && marks[from].y != none; from = to) {
        to = surface_end(from, end);
        const double coverage = means[first + marks[from].y];
        if (coverage == 0) continue;
        if (stays_alone(pixel, from)) emit_nearest(from, to, at);
        else emit_mean(pixel, from, to, coverage, at);
        ++at;
    }
}
