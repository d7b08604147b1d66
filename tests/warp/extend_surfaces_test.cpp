// Surfaces that end behind something nearer: a board behind a plate, before a wall.
#include "lens/thin_lens.h"
#include "support/views.h"
#include "warp/warp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace sparselens {
namespace {

constexpr double scale = 12; // R F
constexpr WarpOptions options{.focal_px = 100, .radius = scale / 100};
const Windows windows = windows_of_size(96, 96);
constexpr int row = 48;

// The plate covers what is left of `plate_ends`, the board lies between `board_begins` and `board_ends`: columns of the
// centre view. They have that many rows; from above and below, views see the wall behind them. Disparities; the
// board's may change from left to right.
struct Boards {
    double plate_ends = 48, board_begins = 20, board_ends = 80, rows = 46, rows_of_plate = 46;
    double plate = 40, wall = 4, board = 30, rise = 0;
    std::function<float(double column, double y)> light = [](double, double) { return 0.5f; }; // of the board

    View view(const Imath::V2d &u) const {
        return make_view(windows, options.radius * u, [&](int x, int y) {
            // A point of depth d that the centre view shows at p is seen from u at p - d u.
            const auto row_at = [&](double depth) { return y + 0.5 - depth * u.y; };
            const auto in_rows = [&](double depth, double count) {
                return std::abs(row_at(depth) - row) < count / 2;
            };
            if (x + 0.5 + plate * u.x < plate_ends && in_rows(plate, rows_of_plate))
                return pixel(plate, 0.1f);
            const double column = (x + 0.5 + (board - 48 * rise) * u.x) / (1 - rise * u.x);
            const double depth = board + rise * (column - 48);
            if (column >= board_begins && column < board_ends && in_rows(depth, rows))
                return pixel(depth, light(column, row_at(depth)));
            return pixel(wall, 0.9f);
        });
    }
    Ldi ldi() const {
        Progress silent;
        return warp(five_views([&](const Imath::V2d &u) { return view(u); }), options, silent);
    }

private:
    static ViewPixel pixel(double depth, float light) {
        return {.z = float(scale / depth), .r = light, .g = light, .b = light};
    }
};

struct Sample {
    int column;
    double depth;
    float light;
};

// The samples of the row that lie between the plate and the wall, from right to left.
std::vector<Sample> board_of(const Ldi &ldi, int y = row) {
    std::vector<Sample> samples;
    for (int x = 95; x >= 0; --x)
        for (const std::uint64_t i : ldi.pixel(ldi.windows.index(Imath::V2i(x, y))))
            if (const double depth = scale / double(ldi.z[i]); depth > 8 && depth < 38)
                samples.push_back({x, depth, ldi.values[0][i]});
    return samples;
}
int first_column(const std::vector<Sample> &samples) { return samples.empty() ? 96 : samples.back().column; }

// The plate lies 10 pixels nearer, so the view from the right shows the board 10 pixels behind the plate's edge. A lens
// point in between looks at most sqrt(2) times as far.
TEST(ContinueSurfaces, ContinueAsFarAsTheLensMayLook) {
    const auto samples = board_of(Boards().ldi());
    EXPECT_LE(first_column(samples), 38 - 10);
    EXPECT_GE(first_column(samples), 38 - 15);
    for (const Sample &s : samples) EXPECT_NEAR(s.depth, 30, 0.01) << s.column;
}

// The view from the right sees the wall through the gap between the board and the plate's edge.
TEST(ContinueSurfaces, EndWhereAViewSawThroughThem) {
    Boards boards;
    boards.board_begins = 44;
    EXPECT_EQ(first_column(board_of(boards.ldi())), 44);
}

// Three columns of the board are seen. It continues for two more, which mirror those before the last one.
TEST(ContinueSurfaces, ContinueForAsManyPixelsAsWereSeen) {
    Boards boards;
    boards.board_ends = 41;
    const auto samples = board_of(boards.ldi());
    EXPECT_EQ(first_column(samples), 36);
}

// A slanted board continues at its own slope.
TEST(ContinueSurfaces, KeepTheirSlope) {
    Boards boards;
    boards.rise = 0.1;
    const auto samples = board_of(boards.ldi());
    ASSERT_LE(first_column(samples), 32);
    for (const Sample &s : samples) EXPECT_NEAR(s.depth, 30 + 0.1 * (s.column + 0.5 - 48), 0.15) << s.column;
}

// The colour is the mean of the end and of the pixel as far before it.
TEST(ContinueSurfaces, ShowWhatWasSeenBeforeTheEnd) {
    Boards boards;
    boards.light = [](double column, double) { return column < 40 ? 0.25f : 0.5f; };
    const auto samples = board_of(boards.ldi());
    const auto end = std::ranges::find(samples, 38, &Sample::column);
    ASSERT_NE(end, samples.end());
    for (const Sample &s : samples)
        if (s.column < 38) {
            EXPECT_NEAR(s.light, (end->light + (38 + 38 - s.column < 40 ? 0.25f : 0.5f)) / 2, 1e-3)
                << s.column;
        }
}

// Behind a corner of the plate the board goes on from its right end (light 0.5) and from its upper end (0.2). Each
// counts by its nearness.
TEST(ContinueSurfaces, TheNearerEndCountsMore) {
    Boards boards;
    boards.rows_of_plate = 40; // views saw the board down to row 38
    boards.light = [](double column, double) { return column < 38 ? 0.2f : 0.5f; };
    const Ldi ldi = boards.ldi();
    for (const auto &[column, y] : {std::pair(36, 38), {36, 40}, {35, 38}}) {
        const auto samples = board_of(ldi, y);
        const auto at = std::ranges::find(samples, column, &Sample::column);
        ASSERT_NE(at, samples.end());
        const double from_right = 1.0 / (38 - column), from_above = 1.0 / (y - 37);
        EXPECT_NEAR(at->light, (0.5 * from_right + 0.2 * from_above) / (from_right + from_above), 0.01)
            << column << ',' << y;
    }
}

// A lamp at the end of the board, and one that stands before the end.
TEST(ContinueSurfaces, LampsDoNotContinue) {
    for (const double from : {0, 40}) {
        Boards boards;
        boards.light = [=](double column, double y) {
            return column >= from && column < std::max(from + 2, 40.0) && y > row && y < row + 2 ? 80.0f
                                                                                                 : 0.5f;
        };
        const Ldi ldi = boards.ldi();
        double most = 0;
        for (const int y : {row - 1, row, row + 1, row + 2})
            for (const Sample &s : board_of(ldi, y))
                if (s.column < 38) most = std::max(most, double(s.light));
        EXPECT_LE(most, 0.51) << from;
    }
}

// Fillers continue the last layer.
TEST(ContinueSurfaces, TheLastLayerDoesNot) {
    Boards boards;
    boards.rows = boards.rows_of_plate = 1000;
    EXPECT_EQ(first_column(board_of(boards.ldi())), 38);
}

// The views from above and below see the wall behind the board, but not behind the plate.
TEST(ContinueSurfaces, ALayerDoesBeforeWhatWasSeenBehindItsEnd) {
    Boards boards;
    boards.rows_of_plate = 1000;
    Progress silent;
    const auto samples =
        board_of(warp({boards.view({0, 0}), boards.view({0, 1}), boards.view({0, -1})}, options, silent));
    EXPECT_LE(first_column(samples), 48 - 10);
    EXPECT_GE(first_column(samples), 48 - 15);
}

// The added samples lie behind the plate, so the centre view still shows the plate.
TEST(ContinueSurfaces, LieBehindWhatTheCentreShows) {
    const Ldi ldi = Boards().ldi();
    for (int x = 0; x < 48; ++x) {
        const SampleRange samples = ldi.pixel(ldi.windows.index(Imath::V2i(x, row)));
        ASSERT_FALSE(samples.empty());
        EXPECT_NEAR(scale / double(ldi.z[samples.front()]), 40, 0.01);
        for (std::uint64_t i = samples.from; i + 1 < samples.to; ++i) EXPECT_LE(ldi.z[i], ldi.z[i + 1]);
    }
}

} // namespace
} // namespace sparselens
