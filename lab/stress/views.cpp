#include "base/error.h"
#include "base/numbers.h"
#include "deep/checks/pose_check.h"
#include "deep/flatten.h"
#include "lab/methods/accumulate.h"
#include "lab/stress/scenes.h"
#include "view/view.h"
#include "warp/warp.h"

#include <algorithm>
#include <array>

namespace sparselens::lab {

namespace {

using namespace stress;

constexpr double focal_px = 200, front_z = 2, back_z = 12;
constexpr float infinity = std::numeric_limits<float>::infinity();

// A smooth texture; the front object is a round disc without holes. Positions are those of the centre view, in pixels.
double light(double x, double y, double phase) {
    return 0.5 + 0.3 * std::sin(0.7 * x + phase) * std::cos(0.45 * y - 0.2 * x);
}

View view_from(const Imath::V2d &position, const Windows &windows, float noise = 0) {
    View view{"view", Image(windows, rgba_channels()), std::vector<float>(windows.pixels()), position};
    std::size_t i = 0;
    for (int y = windows.data.min.y; y <= windows.data.max.y; ++y)
        for (int x = windows.data.min.x; x <= windows.data.max.x; ++x, ++i) {
            const auto seen = [&](double z) {
                return Imath::V2d(x + 0.5 + focal_px / z * position.x,
                                  y + 0.5 - focal_px / z * position.y * double(windows.pixel_aspect));
            };
            const Imath::V2d front = seen(front_z), back = seen(back_z);
            const bool in_front = (front - Imath::V2d(30, 22)).length() < 12;
            const double value = in_front ? light(front.x, front.y, 1) : light(back.x, back.y, 0);
            const double off =
                double(noise) *
                (unit_interval(mix_bits(std::uint32_t(i), std::uint32_t(position.x * 1e4))) - 0.5);
            view.z[i] = float(in_front ? front_z : back_z);
            view.image.at(0, x, y) = view.image.at(1, x, y) = view.image.at(2, x, y) =
                float(value * (1 + off));
            view.image.at(3, x, y) = 1;
        }
    return view;
}
View centre_view() { return view_from({0, 0}, window(72, 48)); }
View rim_view(const Imath::V2d &position) { return view_from(position, window(72, 48)); }

Ldi warped(std::vector<View> views, StressResult &result, Merge merge = Merge::average) {
    Progress silent;
    result.pixels = double(views[0].image.windows.pixels());
    return warp(views, {.focal_px = focal_px, .radius = 0.05, .merge = merge}, silent);
}

// The flattened LDI against the centre view.
StressResult flattened(const std::vector<View> &views, Merge merge = Merge::average) {
    StressResult result;
    const Image flat = flatten(warped(views, result, merge)), &centre = views[0].image;
    const Imath::Box2i &box = centre.windows.data;
    result.error = off_from(crop(flat, box), centre, box);
    result.energy = sum_of(crop(flat, box), 0) / sum_of(centre, 0) - 1;
    return result;
}

StressResult one_view() { return flattened({centre_view()}); }
StressResult identical_views() { return flattened(std::vector<View>(5, centre_view())); }
StressResult same_lens_point() {
    StressResult result;
    const View rim = rim_view({0.05, 0});
    const Image once = flatten(warped({centre_view(), rim}, result)),
                twice = flatten(warped({centre_view(), rim, rim}, result));
    const Imath::Box2i box({0, 0}, {71, 47});
    // The mean leans towards the rim view, whose pixels are up to half a pixel off: the error is the texture's change
    // over that distance.
    result.error = off_from(crop(twice, box), crop(once, box), box);
    return result;
}
StressResult kept_centre() {
    return flattened({centre_view(), rim_view({0.05, 0}), rim_view({-0.05, 0}), rim_view({0, 0.05})},
                     Merge::keep);
}

StressResult other_display() {
    StressResult result{.error = 1};
    Windows other = window(72, 48);
    other.display.max.x += 1;
    try {
        warped({centre_view(), view_from({0.05, 0}, other)}, result);
    } catch (const Error &error) {
        result.error = std::string(error.what()).find("display window") == std::string::npos;
    }
    return result;
}
StressResult other_data() {
    Windows part = window(72, 48), more = part;
    part.data = {{20, 10}, {50, 30}};
    more.data = {{-9, -7}, {90, 60}};
    return flattened({centre_view(), view_from({0.05, 0}, part), view_from({0, 0.05}, more)}, Merge::keep);
}

// Whether the tool finds the true position of a view from `actual` that claims to be from `stated`: 0 if the answer is
// right, else 1.
double found_out(const Imath::V2d &actual, const Imath::V2d &stated, float noise = 0) {
    View view = view_from(actual, window(72, 48), noise);
    view.position = stated;
    const auto better = better_position(centre_view(), view, focal_px);
    const bool wrong = (actual - stated).length() > 0;
    if (better.has_value() != wrong) return 1;
    return wrong && (*better - actual).length() > 1e-9 ? 1 : 0;
}
StressResult wrong_way() {
    StressResult result;
    for (const Imath::V2d &p : {Imath::V2d(0.05, 0), {0, -0.05}, {0.03, 0.04}, {-0.04, 0.03}})
        for (const float noise : {0.0f, 0.5f}) result.error += found_out(p, -p, noise);
    return result;
}
StressResult wrong_axis() {
    StressResult result;
    result.error = found_out({0.04, 0.03}, {0.04, -0.03}) + found_out({0.05, 0}, {0, 0.05}) +
                   found_out({0, 0}, {0.05, 0});
    return result;
}
StressResult right_way() {
    StressResult result;
    for (const Imath::V2d &p :
         {Imath::V2d(0.05, 0), {0, -0.05}, {0.03, 0.04}, {-0.04, 0.03}, {0, 0}, {1e-6, 0}})
        for (const float noise : {0.0f, 0.5f, 1.9f}) result.error += found_out(p, p, noise);
    return result;
}

// Views of only sky, of things nearer than a float's smallest inverse, and of nothing.
StressResult extreme_depths() {
    StressResult result;
    for (const float z : {infinity, 3e38f, std::numeric_limits<float>::min()}) {
        View centre = centre_view(), rim = rim_view({0.05, 0});
        std::ranges::fill(centre.z, z);
        std::ranges::fill(rim.z, z);
        const Image flat = crop(flatten(warped({centre, rim}, result)), centre.image.windows.data);
        // All views see the sky alike. Only the centre view has what is too near for the rim view.
        for (const float v : flat.values)
            if (!std::isfinite(v) || v < 0 || v > 1.001f) result.error = 1;
        result.error = std::max(result.error, off_from(flat, 3, flat.windows.data, 1));
    }
    return result;
}

StressResult accumulated() {
    StressResult result;
    const View view = centre_view();
    Accumulation sum = start_accumulation(view.image.windows, view.image.channels);
    for (int i = 0; i < 1000; ++i) accumulate(sum, view.image, {0, 0}, "view");
    result.error = off_from(average(sum), view.image, view.image.windows.data);
    return result;
}

constexpr const char *copied = "samples are the centre view's own";
constexpr const char *yes_or_no = "yes or no";

constexpr std::array cases{
    StressCase{"one_view", "one view, flattened, is the view", 1e-6,
               "pixels at silhouettes are split in two, which float's rounding puts together again",
               one_view},
    StressCase{"identical_views", "five times the same view is the view", 1e-6,
               "the mean of equal values, rounded to float", identical_views},
    StressCase{"same_lens_point", "two views from one lens point, against one of them", 0.15,
               "a mean that leans by a third to samples up to half a pixel off: half the texture's slope, "
               "0.2 a pixel, at most",
               same_lens_point},
    StressCase{"keep", "--merge keep, flattened, is the centre view", 0, copied, kept_centre},
    StressCase{"other_display_window", "a view of another display window is an error that says so", 0,
               yes_or_no, other_display},
    StressCase{"other_data_windows",
               "views of smaller and larger data windows, kept, flattened, are the centre view", 0, copied,
               other_data},
    StressCase{"wrong_way", "views moved the wrong way are found out, also with noise, and where they stand",
               0, yes_or_no, wrong_way},
    StressCase{"wrong_axis",
               "views with an axis turned round, axes swapped or not moved at all are found out", 0,
               yes_or_no, wrong_axis},
    StressCase{"right_way", "views that stand where they are said to are not complained of, also with noise",
               0, yes_or_no, right_way},
    StressCase{"depths_of_views", "views at z = inf, 3e38 and 1.2e-38 give finite, opaque LDIs", 1e-6,
               "A is 1 in every sample", extreme_depths},
    StressCase{"accumulate_1000", "a thousand times the same view, accumulated, is the view", 1e-7,
               "sums are double, rounded to float once", accumulated},
};

} // namespace

std::span<const StressCase> view_stress() { return cases; }

} // namespace sparselens::lab
