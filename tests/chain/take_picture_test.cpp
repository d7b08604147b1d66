// Pictures whose values and notices are known in closed form, tested once below all front ends.
#include "base/error.h"
#include "chain/notices.h"
#include "chain/take_picture.h"
#include "io/camera/camera_header.h"
#include "io/exr/exr_deep.h"
#include "support/lens_ldi.h"
#include "support/scratch_folder.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace sparselens {
namespace {

// 40 x 30 pixels of a camera whose focal length is 640 pixels; f-number and focus are those of `lens`.
const ThinLens lens{.radius = 0.06, .focal_px = 640, .focus = 5};

OpenedLdi opened(Ldi ldi) {
    OpenedLdi in;
    in.name = "x.exr";
    in.header = Imf::Header(ldi.windows.display, ldi.windows.data);
    in.ldi = std::move(ldi);
    in.samples_read = in.ldi.samples();
    in.camera.focal_length_mm = lens.focal_px;
    in.camera.sensor_width_mm = 40;
    in.camera.lens_radius = lens.radius;
    in.camera.focus_distance = lens.focus;
    return in;
}

// A grey plane of CoC c, with a lamp in one pixel.
OpenedLdi plane(double c, const Imath::V2i &lamp = {20, 15}) {
    return opened(make_ldi(windows_of_size(40, 30), rgba_channels(), [&](int x, int y) {
        const float light = Imath::V2i(x, y) == lamp ? 50.0f : 0.5f;
        return std::vector<Sample>{{depth_of(lens, c), {light, light / 2, light / 4, 1}}};
    }));
}

PictureRequest pinhole() {
    PictureRequest request;
    request.lens.lens_radius = 0;
    return request;
}

struct Told {
    std::vector<Notice> notices;
    const Notice *find(NoticeKind kind) const {
        const auto found = std::ranges::find(notices, kind, &Notice::kind);
        return found == notices.end() ? nullptr : &*found;
    }
};

TakenPicture taken(const OpenedLdi &in, const PictureRequest &request, Told *told = nullptr) {
    Progress silent;
    return take_picture(in, request, {silent, [&](const Notice &notice) {
                                          if (told) told->notices.push_back(notice);
                                      }});
}

TEST(TakePicture, HasTheCameraThatItWasTakenWith) {
    PictureRequest request = pinhole();
    request.lens.focus_distance = 3;
    const OpenedLdi in = plane(4);
    const TakenPicture picture = taken(in, request);
    EXPECT_EQ(picture.camera.focus_distance, 3);
    EXPECT_EQ(read_camera(picture.header).focus_distance, 3);
    EXPECT_EQ(in.camera.focus_distance, lens.focus);
    EXPECT_EQ(picture.image.at(0, 20, 15), 50);
    EXPECT_EQ(picture.image.at(1, 3, 4), 0.25f);
}

// A board hides a part of a wall, which may continue behind it, so that the lamp does not shine there.
TEST(TakePicture, LetsNoLampShineWhereNothingWasSeen) {
    OpenedLdi in = opened(make_ldi(windows_of_size(40, 30), rgba_channels(), [&](int x, int y) {
        const float light = x == 5 && y == 15 ? 900.0f : 0.5f;
        const double c = x >= 11 && x < 14 ? -6 : x >= 8 && x < 17 ? 1 : 7;
        return std::vector<Sample>{{depth_of(lens, c), {light, light, light, 1}}};
    }));
    for (const bool deep : {true, false}) {
        in.deep = deep;
        EXPECT_LT(taken(in, {}).image.at(0, 12, 15), 0.6f);
    }
}

// The focus is the depth of the middle sub-pixel, and the lens is in pixels of the picture.
TEST(TakePicture, FocusesOnWhatAPixelShows) {
    Told told;
    PictureRequest request;
    request.focus_pixel = Imath::V2i(3, 2);
    request.windows.supersample = 2;
    const OpenedLdi in = opened(make_ldi(windows_of_size(40, 30), rgba_channels(), [](int x, int y) {
        return std::vector<Sample>{{double(1 + x + 100 * y), {1, 1, 1, 1}}};
    }));
    const TakenPicture picture = taken(in, request, &told);
    EXPECT_EQ(picture.camera.focus_distance, 1 + 7 + 100 * 5);
    EXPECT_EQ(picture.lens.focal_px, 320);
    EXPECT_EQ(picture.lens.focus, 508);
    ASSERT_TRUE(told.find(NoticeKind::focused));
    EXPECT_EQ(words_of(*told.find(NoticeKind::focused)), "the focus distance is 508, the depth of pixel 3,2");
    request.focus_pixel = Imath::V2i(20, 0);
    EXPECT_THROW(taken(in, request), UsageError);
    OpenedLdi empty = in;
    empty.ldi =
        make_ldi(windows_of_size(40, 30), rgba_channels(), [](int, int) { return std::vector<Sample>(); });
    request.focus_pixel = Imath::V2i(3, 2);
    EXPECT_EQ(what_of<UsageError>([&] { taken(empty, request); }),
              "`focus_pixel`: x.exr has no sample at (3, 2); choose a pixel that shows something");
}

// The camera of the file is told, too, so the last word is that of the options.
TEST(TakePicture, TellsTheLensThatIsUsed) {
    Told told;
    PictureRequest request;
    request.lens.focus_distance = 2.5;
    taken(plane(4), request, &told);
    ASSERT_TRUE(told.find(NoticeKind::used_lens));
    EXPECT_EQ(words_of(*told.find(NoticeKind::used_lens)),
              "the picture is that of a lens of radius 0.06, focal length 640 pixels, focused at 2.5");
    Told sharp;
    taken(plane(4), pinhole(), &sharp);
    EXPECT_FALSE(sharp.find(NoticeKind::used_lens));
}

TEST(TakePicture, IsTheMeanOfSubpixels) {
    PictureRequest request = pinhole();
    request.windows.supersample = 2;
    request.front_depth = true;
    const TakenPicture picture = taken(plane(4), request);
    EXPECT_EQ(picture.image.windows.data, Imath::Box2i({0, 0}, {19, 14}));
    EXPECT_FLOAT_EQ(picture.image.at(0, 10, 7), (50 + 3 * 0.5f) / 4);
    EXPECT_FLOAT_EQ(picture.image.at(0, 0, 0), 0.5f);
    EXPECT_FLOAT_EQ(picture.depth.at(0, 5, 5), float(depth_of(lens, 4)));
    request.show = Show::layers; // one sample: grey
    const Image shown = taken(plane(4), request).image;
    EXPECT_EQ(shown.windows.data, picture.image.windows.data);
    EXPECT_EQ(shown.at(0, 1, 1), shown.at(1, 1, 1));
}

// The frame cuts off the disc of a lamp at the border, 4.7 pixels across, but not that of a lamp in the middle.
TEST(TakePicture, TellsThatOverscanIsMissing) {
    Told lit, dark;
    taken(plane(4.7, {0, 7}), {}, &lit);
    taken(plane(4.7), {}, &dark);
    ASSERT_TRUE(lit.find(NoticeKind::missing_overscan));
    EXPECT_EQ(words_of(*lit.find(NoticeKind::missing_overscan)),
              "x.exr: the blur reaches 5 pixels beyond the frame, and 0 were rendered there; discs of lights "
              "outside the frame are missing, so render more overscan");
    EXPECT_EQ(level_of(*lit.find(NoticeKind::missing_overscan)), NoticeLevel::once);
    EXPECT_FALSE(dark.find(NoticeKind::missing_overscan));
    ASSERT_TRUE(dark.find(NoticeKind::overscan));
    EXPECT_EQ(level_of(*dark.find(NoticeKind::overscan)), NoticeLevel::note);
}

TEST(TakePicture, TellsThatTheBlurIsWiderThanThePicture) {
    Told narrow, wide;
    taken(plane(-39), {}, &narrow);
    taken(plane(-41), {}, &wide);
    EXPECT_FALSE(narrow.find(NoticeKind::too_much_blur));
    ASSERT_TRUE(wide.find(NoticeKind::too_much_blur));
    EXPECT_EQ(words_of(*wide.find(NoticeKind::too_much_blur)),
              "x.exr: the blur reaches 42 pixels beyond the frame, which is farther than it is wide, so the "
              "lens sees little that is known: check the aperture, the focus and the unit of the scene");
}

TEST(TakePicture, TellsOfALensThatIsWiderThanItsViews) {
    OpenedLdi in = plane(0);
    in.camera.lens_points = {{0, 0}, {0.03, 0.04}};
    for (const double radius : {0.05, 0.06}) {
        Told told;
        PictureRequest request;
        request.lens.lens_radius = radius;
        taken(in, request, &told);
        ASSERT_EQ(told.find(NoticeKind::wide_lens) != nullptr, radius > 0.05) << radius;
        if (radius > 0.05) {
            EXPECT_EQ(told.find(NoticeKind::wide_lens)->parameter, "fstop");
        }
    }
}

TEST(TakePicture, TakesTheApertureForRoundWhereTheMethodKnowsNoLooks) {
    OpenedLdi in = plane(4);
    PictureRequest request;
    for (const GatherMethod &method : gather_methods())
        if (std::string(method.name) == "selective") request.picture.method = &method;
    const Image round = taken(in, request).image;
    in.camera.looks.squeeze = 2;
    Told told;
    EXPECT_EQ(taken(in, request, &told).image.values, round.values);
    ASSERT_TRUE(told.find(NoticeKind::round_aperture));
    EXPECT_EQ(words_of(*told.find(NoticeKind::round_aperture)),
              "method selective ignores the aperture's shape, and takes a disc");
}

TEST(TakePicture, HasTheChannelsThatAreAskedFor) {
    PictureRequest request = pinhole();
    request.channels = "G";
    const OpenedLdi in = plane(4);
    const Image picture = taken(in, request).image;
    ASSERT_EQ(picture.channels.size(), 1u);
    EXPECT_EQ(picture.at(0, 3, 4), 0.25f);
    EXPECT_EQ(in.ldi.channels.size(), 4u);
    request.channels = "N";
    EXPECT_THROW(taken(in, request), UsageError);
    OpenedLdi bare = in;
    bare.ldi.channels.clear();
    bare.ldi.values.clear();
    EXPECT_THROW(taken(bare, {}), Error);
}

// A card before the left half of the picture, in sub-pixels or in pixels of the picture.
TEST(TakePicture, IsHeldOut) {
    for (const int across : {1, 2}) {
        const OpenedLdi card =
            opened(make_ldi(windows_of_size(40 / across, 30 / across), {{"A"}}, [&](int x, int) {
                return x < 20 / across ? std::vector<Sample>{{1, {1}}} : std::vector<Sample>();
            }));
        PictureRequest request = pinhole();
        request.windows.supersample = across;
        request.opened_holdout = &card;
        const Image picture = taken(plane(4), request).image;
        EXPECT_EQ(picture.at(0, 20 / across - 1, 3), 0) << across;
        EXPECT_EQ(picture.at(0, 20 / across, 3), 0.5f) << across;
    }
}

// Highlights are brightened in a copy: 50 becomes 2 x 50, far above threshold and knee.
TEST(TakePicture, LeavesTheLdiAsItIs) {
    const OpenedLdi in = plane(4);
    PictureRequest request = pinhole();
    request.looks.values.highlight_gain = 2;
    EXPECT_FLOAT_EQ(taken(in, request).image.at(0, 20, 15), 100);
    EXPECT_FLOAT_EQ(taken(in, pinhole()).image.at(0, 20, 15), 50);
}

TEST(TakePicture, OfAProxyThatWasMadeBeforeIsTheSame) {
    PictureRequest request;
    request.windows.proxy = 2;
    const OpenedLdi in = plane(6);
    OpenedLdi without = in; // samples
    without.ldi = {};
    without.ldi.windows = in.ldi.windows;
    without.ldi.channels = in.ldi.channels;
    Progress silent;
    const auto nobody = [](const Notice &) {};
    const TakenPicture before =
        take_picture(without, gather_windows(request.windows, in), request, {silent, nobody});
    EXPECT_EQ(before.image.values, taken(in, request).image.values);
    EXPECT_EQ(before.image.windows.display, Imath::Box2i({0, 0}, {19, 14}));
}

TEST(TakePicture, ReadsAFileAnewWhenItsSamplesAreUsedUp) {
    const ScratchFolder folder;
    PictureRequest request;
    request.input = folder.file("x.exr");
    const OpenedLdi in = plane(4);
    write_ldi(request.input, in.ldi, in.header);
    request.lens = {.focal_length_mm = 640, .sensor_width_mm = 40, .lens_radius = 0.06, .focus_distance = 5};
    Progress silent;
    const auto nobody = [](const Notice &) {};
    for (const bool keep : {false, true}) {
        LdiCache cache;
        const Image first = take_picture(cache, keep, request, {silent, nobody}).image;
        EXPECT_TRUE(cache.read_now());
        EXPECT_EQ(take_picture(cache, keep, request, {silent, nobody}).image.values, first.values);
        EXPECT_EQ(cache.read_now(), !keep);
    }
}

TEST(CheckMethod, RefusesWhatHasNoEffect) {
    PictureRequest request;
    const auto says = [&](const std::string &given) {
        return what_of<UsageError>(
            [&] { check_method(request, [&](const std::string &parameter) { return parameter == given; }); });
    };
    const std::string none = "(nothing was thrown)";
    EXPECT_EQ(says("quality"), none);
    EXPECT_EQ(says("layers"), "`layers`: works with `method=selective` only");
    request.picture.method = &gather_methods()[1];
    EXPECT_EQ(says("layers"), none);
    for (const std::string parameter : {"quality", "holdout", "lens", "cat_eye", "field_curvature"})
        EXPECT_EQ(says(parameter), "`" + parameter + "`: works with `method=lens` only");
    request.show = Show::tiles;
    EXPECT_EQ(says(""), "`show=tiles`: works with `method=lens` only");
}

} // namespace
} // namespace sparselens
