#include "base/error.h"
#include "base/numbers.h"
#include "deep/checks/pose_check.h"
#include "deep/flatten.h"
#include "lab/methods/accumulate.h"
#include "lab/tests/stress/stress.h"
#include "support/scratch_folder.h"
#include "support/views.h"
#include "warp/warp.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sparselens::stress {

namespace {

constexpr double focal_px = 200, front_z = 2, back_z = 12;
const Windows frame = windows_of_size(72, 48);

// A smooth texture; the front object is a round disc without holes. Positions are those of the centre view, in pixels.
double light(double x, double y, double phase) {
    return 0.5 + 0.3 * std::sin(0.7 * x + phase) * std::cos(0.45 * y - 0.2 * x);
}

View view_from(const Imath::V2d &position, const Windows &windows = frame, float noise = 0) {
    return make_view(windows, position, [&](int x, int y) {
        const auto seen = [&](double z) {
            return Imath::V2d(x + 0.5 + focal_px / z * position.x,
                              y + 0.5 - focal_px / z * position.y * double(windows.pixel_aspect));
        };
        const Imath::V2d front = seen(front_z), back = seen(back_z);
        const bool in_front = (front - Imath::V2d(30, 22)).length() < 12;
        const double value = in_front ? light(front.x, front.y, 1) : light(back.x, back.y, 0);
        const std::uint32_t random =
            mix_bits(std::uint32_t(windows.index(Imath::V2i(x, y))), std::uint32_t(position.x * 1e4));
        const float grey = float(value * (1 + double(noise) * (unit_interval(random) - 0.5)));
        return ViewPixel{float(in_front ? front_z : back_z), grey, grey, grey};
    });
}
View centre_view() { return view_from({0, 0}); }

Image flattened(std::vector<View> views, Merge merge = Merge::average) {
    Progress silent;
    const Windows windows = views[0].image.windows;
    const Ldi ldi = warp(views, {.focal_px = focal_px, .radius = 0.05, .merge = merge}, silent);
    return crop(flatten(ldi), windows.data);
}
// The flattened LDI against the centre view.
Result against_centre(const std::vector<View> &views, Merge merge = Merge::average) {
    const Image flat = flattened(views, merge), &centre = views[0].image;
    return {off_from(flat, centre), sum_of(flat, 0) / sum_of(centre, 0) - 1};
}

// The mean leans towards the rim view, whose pixels are up to half a pixel off: the error is the texture's change over
// that distance.
Result same_lens_point() {
    const View rim = view_from({0.05, 0});
    return {off_from(flattened({centre_view(), rim, rim}), flattened({centre_view(), rim}))};
}

Result other_display() {
    Windows other = frame;
    other.display.max.x += 1;
    const std::string said = what_of<Error>([&] { flattened({centre_view(), view_from({0.05, 0}, other)}); });
    EXPECT_NE(said.find("display window"), std::string::npos) << said;
    return {};
}
Result other_data() {
    Windows part = frame, more = frame;
    part.data = {{20, 10}, {50, 30}};
    more.data = {{-9, -7}, {90, 60}};
    return against_centre({centre_view(), view_from({0.05, 0}, part), view_from({0, 0.05}, more)},
                          Merge::keep);
}

// Whether the tool finds the true position of a view from `actual` that claims to be from `stated`: 0 if the answer is
// right, else 1.
double found_out(const Imath::V2d &actual, const Imath::V2d &stated, float noise = 0) {
    View view = view_from(actual, frame, noise);
    view.position = stated;
    const auto better = better_position(centre_view(), view, focal_px);
    const bool wrong = (actual - stated).length() > 0;
    if (better.has_value() != wrong) return 1;
    return wrong && (*better - actual).length() > 1e-9 ? 1 : 0;
}
Result wrong_way() {
    Result result;
    for (const Imath::V2d &p : {Imath::V2d(0.05, 0), {0, -0.05}, {0.03, 0.04}, {-0.04, 0.03}})
        for (const float noise : {0.0f, 0.5f}) result.error += found_out(p, -p, noise);
    return result;
}
Result wrong_axis() {
    return {found_out({0.04, 0.03}, {0.04, -0.03}) + found_out({0.05, 0}, {0, 0.05}) +
            found_out({0, 0}, {0.05, 0})};
}
Result right_way() {
    Result result;
    for (const Imath::V2d &p :
         {Imath::V2d(0.05, 0), {0, -0.05}, {0.03, 0.04}, {-0.04, 0.03}, {0, 0}, {1e-6, 0}})
        for (const float noise : {0.0f, 0.5f, 1.9f}) result.error += found_out(p, p, noise);
    return result;
}

// Views of only sky, of things nearer than a float's smallest inverse, and of nothing.
Result extreme_depths() {
    Result result;
    for (const float z : {INFINITY, 3e38f, std::numeric_limits<float>::min()}) {
        View centre = centre_view(), rim = view_from({0.05, 0});
        std::ranges::fill(centre.z, z);
        std::ranges::fill(rim.z, z);
        const Image flat = flattened({centre, rim});
        // All views see the sky alike. Only the centre view has what is too near for the rim view.
        for (const float v : flat.values) EXPECT_TRUE(v >= 0 && v <= 1.001f) << v;
        result.error = std::max(result.error, off_from(flat, 3, flat.windows.data, 1));
    }
    return result;
}

Result accumulated() {
    const View view = centre_view();
    Accumulation sum = start_accumulation(view.image.windows, view.image.channels);
    for (int i = 0; i < 1000; ++i) accumulate(sum, view.image, {0, 0}, "view");
    return {off_from(average(sum), view.image)};
}

constexpr Limit split{1e-6,
                      "pixels at silhouettes are split in two, which float's rounding puts together again"};
constexpr Limit slope{0.15, "a mean that leans by a third to samples up to half a pixel off: half the "
                            "texture's slope, 0.2 a pixel, at most"};
constexpr Limit copied{0, "samples are the centre view's own"};
constexpr Limit yes_or_no{0, "yes or no"};

constexpr Case cases[] = {
    {"one_view", "one view, flattened, is the view", split, [] { return against_centre({centre_view()}); }},
    {"identical_views",
     "five times the same view is the view",
     {1e-6, "the mean of equal values, rounded to float"},
     [] { return against_centre(std::vector<View>(5, centre_view())); }},
    {"same_lens_point", "two views from one lens point, against one of them", slope, same_lens_point},
    {"keep", "--merge keep, flattened, is the centre view", copied,
     [] {
         return against_centre(
             {centre_view(), view_from({0.05, 0}), view_from({-0.05, 0}), view_from({0, 0.05})}, Merge::keep);
     }},
    {"other_display_window", "a view of another display window is an error that says so", yes_or_no,
     other_display},
    {"other_data_windows", "views of smaller and larger data windows, kept, flattened, are the centre view",
     copied, other_data},
    {"wrong_way", "views moved the wrong way are found out, also with noise, and where they stand", yes_or_no,
     wrong_way},
    {"wrong_axis", "views with an axis turned round, axes swapped or not moved at all are found out",
     yes_or_no, wrong_axis},
    {"right_way", "views that stand where they are said to are not complained of, also with noise", yes_or_no,
     right_way},
    {"depths_of_views",
     "views at z = inf, 3e38 and 1.2e-38 give finite, opaque LDIs",
     {1e-6, "A is 1 in every sample"},
     extreme_depths},
    {"accumulate_1000",
     "a thousand times the same view, accumulated, is the view",
     {1e-7, "sums are double, rounded to float once"},
     accumulated},
};

} // namespace

INSTANTIATE_TEST_SUITE_P(views, Stress, testing::ValuesIn(cases), name_of);

} // namespace sparselens::stress
